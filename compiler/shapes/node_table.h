// The node table: one row per kind of node, and the only list of them. The JSON front end, the error messages, the
// graph printer, the bounds, the lowering and the tests read it.
//
// Conventions, the same for every node:
//   - primitives are centred at the origin, symmetric ones about the y axis (right-handed, y up);
//   - every length is a radius or a half extent, in scene units, and includes any rounding;
//   - angles are in degrees;
//   - `k` is the width of a smooth blend; the surface moves by at most k/4;
//   - a `thickness` is measured to either side: a wall is 2 * thickness thick.
// Tested by: tests/compiler/shapes_test.cpp
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/box.h"
#include "compiler/graph.h"
#include "vm/opcode.h"

namespace fathom::compiler {

enum class ParamType { Number, Integer, Vec3 };

// What a parameter's value must satisfy on its own; each is an error that names the rule.
enum class Rule { Any, Positive, NotNegative, NotZero };

struct ParamSpec {
  std::string_view name;
  ParamType type;
  Rule rule;
  std::optional<double> fallback;  // used when the property is absent; required when empty
  std::string_view doc;
};

enum class Category { Primitive, Alteration, Combinator, Internal };

// How far a distance can be trusted. Exact implies bound; a bound never exceeds the true distance.
enum class Exactness { Exact, Bound, Estimate };

struct NodeSpec {
  Kind kind;
  std::string_view name;  // the `type` in scene files
  Category category;
  std::vector<ParamSpec> params;
  std::string_view doc;

  // What is wrong with parameters that are each valid but do not fit together, and what would be right; nullopt when
  // nothing is. May be null.
  std::optional<std::string> (*check)(std::span<const double> params);

  // Primitives only, else null: the opcode, its immediates, the smallest box around the solid that is cheap to know.
  std::optional<vm::Opcode> opcode;
  std::vector<double> (*immediates)(std::span<const double> params);
  Box (*bound)(std::span<const double> params);
  Exactness outside, inside;
};

const std::vector<NodeSpec>& node_table();
const NodeSpec& spec(Kind kind);
const NodeSpec* find_node(std::string_view name);  // nullptr when there is none of that name

// How many doubles a parameter takes in a node.
inline int width(ParamType type) { return type == ParamType::Vec3 ? 3 : 1; }

}  // namespace fathom::compiler
