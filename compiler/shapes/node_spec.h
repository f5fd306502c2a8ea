// A row of the node table: parameters, code, bounds and knowledge of one kind of node.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/graph/graph.h"
#include "compiler/graph/knowledge.h"
#include "vm/program/opcode.h"

namespace fathom::compiler {

class NodeMaker;  // compiler/shapes/make_node.h

using Params = std::span<const double>;
using Complaint = std::optional<std::string>;

// Points: a list of [x, y], as many as there are; the last parameter of its row.
// Formula: text in x, y, z and the scene's parameters; becomes the node's (last) child and no numbers.
enum class ParamType { Number, Integer, Vec2, Vec3, Counts, Points, Formula };

// What a parameter's value must satisfy on its own; each is an error that names the rule.
enum class Rule { Any, Positive, NotNegative, NotZero };

struct ParamSpec {
  std::string_view name;
  ParamType type;
  Rule rule;
  std::optional<double> fallback;  // used when the property is absent; required when empty
  std::string_view doc;
};

// Primitives have no children, alterations one, combinators any number; functions of numbers appear in formulas only.
enum class Category { Primitive, Alteration, Combinator, Function, Internal };

// What a node's value is: a distance in space, a distance in the xy plane, a plain number.
enum class Sort { Solid, Outline, Number };

struct Instruction {
  vm::Opcode opcode;
  std::vector<double> immediates = {};
  std::uint32_t operand = 0;
};

// How a node is evaluated: instructions of the machine, emitted by compiler/lower/lower.cpp.
struct Code {
  // A node with one child evaluates it once for each of these chains of Point instructions, each from the caller's
  // point, and takes the least of the values.
  std::vector<std::vector<Instruction>> points = {{}};
  // Then, at the caller's point: a primitive's value is pushed, an altered one changed, a combinator's next operand
  // joined to the value below it.
  std::vector<Instruction> after = {};
  // How a combinator of two operands is evaluated with the second first: what follows the second, then what joins the
  // first to it. Empty `swapped_join`: not possible.
  std::vector<Instruction> swapped_first = {}, swapped_join = {};
  // `after` follows the last operand alone and takes all of them.
  bool all_at_once = false;
  // The operands may come in any order.
  bool any_order = false;
};

// What a primitive knows of itself beside its box.
struct PrimitiveFacts {
  Exactness outside = Exactness::Exact, inside = Exactness::Exact;
  std::array<bool, 3> symmetric = {false, false, false};  // as Knowledge::symmetric
};

// Primitives between two points: `a` and `b` may be given in place of the parameter `length`, which is then |b - a|
// times `share`; the node's y axis turns from a to b, its origin at their middle (share 1/2) or at a (share 1).
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

  Sort sort = Sort::Solid;                     // of a node's value; of Solid, when the operands decide (see operand)
  std::optional<Sort> operand = std::nullopt;  // of the children; nullopt: solids or outlines, and the result is such

  // What is wrong with parameters that are each valid but do not fit together, and what would be right; nullopt when
  // nothing is. May be null.
  Complaint (*check)(Params params) = nullptr;

  Code (*code)(Params params) = nullptr;
  // The smallest box around a primitive that is cheap to know.
  Box (*bound)(Params params) = nullptr;
  PrimitiveFacts facts = {};
  double (*magnitude)(Params params) = nullptr;  // as Knowledge::magnitude; null: 0
  // What is known given what is known of the children; null for primitives, whose rows have `bound` and `facts`.
  Knowledge (*know)(Params params, std::span<const Knowledge> children) = nullptr;

  // Numbers the compiler derives when the node is made, which follow the parameters in the graph (a twist needs its
  // child's radius). May be null.
  std::vector<double> (*derive)(Params params, std::span<const Knowledge> children) = nullptr;
  // What is wrong with the node given its children; as `check`. May be null.
  Complaint (*check_children)(Params params, std::span<const Knowledge> children) = nullptr;
  // Alterations that are made of other nodes: as `expand`, over the children.
  NodeId (*build)(NodeMaker& maker, Params params, std::span<const NodeId> children, const Origin& origin) = nullptr;
  // Primitives that are made of other nodes: adds those and returns the one that stands for it. Null for all that
  // have code.
  NodeId (*expand)(Graph& graph, Params params, const Origin& origin) = nullptr;

  std::optional<Between> between = std::nullopt;

  // All numbers of a node over these children, as they stand in the graph: the parameters, then what is derived.
  std::vector<double> with_derived(Params given, std::span<const Knowledge> children) const;
};

// How many doubles a parameter takes in a node (of each point, for Points).
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
