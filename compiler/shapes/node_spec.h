// A row of the node table: parameters, code, bounds and facts of one kind of node.
#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/graph/graph.h"
#include "compiler/graph/node_facts.h"
#include "vm/program/opcode.h"

namespace fathom::compiler {

class NodeMaker;  // compiler/shapes/make_node.h

using Params = std::span<const double>;
using ErrorText = std::optional<std::string>;

// Points: a list of any number of [x, y], the last parameter of its row. Formula: text in x, y, z and the scene's
// parameters, which becomes the node's (last) child and no numbers.
enum class ParamType { Number, Integer, Vec2, Vec3, Counts, Points, Formula };

// Condition on the value of one parameter. The error for a violation names the rule.
enum class Rule { Any, Positive, NotNegative, NotZero };

struct ParamSpec {
  std::string_view name;
  ParamType type;
  Rule rule;
  std::optional<double> fallback;  // used when the property is absent; nullopt: the property is required
  std::string_view doc;
};

// Primitives have no children, alterations one, combinators any number. Functions of numbers appear in formulas only.
enum class Category { Primitive, Alteration, Combinator, Function, Internal };

// Meaning of a node's value: a distance in space, a distance in the xy plane, a plain number.
enum class Sort { Solid, Outline, Number };

struct Instruction {
  vm::Opcode opcode;
  std::vector<double> immediates = {};
  std::uint32_t operand = 0;
};

// Evaluation of a node: instructions of the machine, which compiler/lower/lower.cpp emits.
struct Code {
  // Chains of Point instructions. A node with one child evaluates the child once per chain, each chain starting at
  // the caller's point, and takes the minimum of the values.
  std::vector<std::vector<Instruction>> points = {{}};
  // Instructions that follow at the caller's point. A primitive pushes its value, an alteration changes its child's,
  // and a combinator joins its next operand to the value below.
  std::vector<Instruction> after = {};
  // Evaluation of two operands of a combinator with the second operand first: the instructions after the second, then
  // those that join the first operand to it. Empty `swapped_join`: the combinator cannot be evaluated in that order.
  std::vector<Instruction> swapped_first = {}, swapped_join = {};
  // True if `after` follows only the last operand and takes all operands.
  bool all_at_once = false;
  // True if the operands may come in any order.
  bool any_order = false;
};

// Most corners of a polygon.
inline constexpr std::size_t kMaxCorners = 4096;

// Facts about a primitive in addition to its box.
struct PrimitiveFacts {
  Exactness outside = Exactness::Exact, inside = Exactness::Exact;
  std::array<bool, 3> symmetric = {false, false, false};  // as NodeFacts::symmetric
};

// Primitives between two points. A scene may give `a` and `b` in place of the parameter `length`, which is then |b -
// a| times `share`. The node's y axis turns from a to b, and its origin moves to their middle (share 1/2) or to a
// (share 1).
struct Between {
  std::string_view length;
  double share;
};

struct NodeSpec {
  Kind kind;
  std::string_view name;  // the `type` in scene files
  Category category;
  std::vector<ParamSpec> params = {};
  std::string_view doc = {};

  // sort of the node's value; Solid also if the operands decide (see `operand`)
  Sort sort = Sort::Solid;
  // true for a function whose operands may be exchanged
  bool commutes = false;
  // sort of the children; nullopt: solids or outlines, and the node's value is of the same sort
  std::optional<Sort> operand = std::nullopt;

  // Returns the conflict between parameters that are each valid, and how to resolve it; nullopt if there is none. May
  // be null.
  ErrorText (*check)(Params params) = nullptr;

  Code (*code)(Params params) = nullptr;
  // Returns the smallest box around a primitive that is cheap to compute.
  Box (*bound)(Params params) = nullptr;
  PrimitiveFacts facts = {};
  double (*cancellation)(Params params) = nullptr;  // as NodeFacts::cancellation; null: 0
  // Returns the corners in order of an outline that has only straight edges. Null for all other rows.
  std::vector<glm::dvec2> (*corners)(Params params) = nullptr;
  // Returns the node's facts, given the children's. Null for primitives, whose rows have `bound` and `facts`.
  NodeFacts (*derive_facts)(Params params, std::span<const NodeFacts> children) = nullptr;

  // Returns the numbers that the compiler derives when it makes the node, which follow the parameters in the graph (a
  // twist needs its child's radius). May be null.
  std::vector<double> (*derive)(Params params, std::span<const NodeFacts> children) = nullptr;
  // Like `check`, for the node given its children. May be null.
  ErrorText (*check_children)(Params params, std::span<const NodeFacts> children) = nullptr;
  // Like `expand`, over the children, for alterations that are composed of other nodes.
  NodeId (*build)(NodeMaker& maker, Params params, std::span<const NodeId> children,
                  const SourceLocation& origin) = nullptr;
  // Adds the nodes that a composed primitive consists of, and returns the node that stands for the primitive. Null
  // for all rows that have code.
  NodeId (*expand)(Graph& graph, Params params, const SourceLocation& origin) = nullptr;

  std::optional<Between> between = std::nullopt;

  // Returns all numbers of a node over these children as in the graph: the parameters, then the derived numbers.
  std::vector<double> with_derived(Params given, std::span<const NodeFacts> children) const;
};

// Returns the number of doubles that a parameter takes in a node (per point for Points).
inline int width(ParamType type) {
  switch (type) {
    case ParamType::Vec2:
    case ParamType::Points:
      return 2;
    case ParamType::Vec3:
    case ParamType::Counts:
      return 3;
    case ParamType::Formula:
      return 0;
    default:
      return 1;
  }
}

}  // namespace fathom::compiler
