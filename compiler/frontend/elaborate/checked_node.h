// A node of a scene file after checking: parameters in the node table's order, names replaced by numbers. Between
// check_node.h, which makes them, and build.h, which makes the graph of them.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "compiler/frontend/formula/formula.h"
#include "compiler/graph/graph.h"

namespace fathom::compiler {

struct CheckedNode {
  Span span;                         // of the whole record
  std::string name;                  // its `name`, or what it is called under `nodes`; "" when neither
  std::string word;                  // its `use` or else its `type`
  Kind kind = Kind::Union;           // of no meaning when `use` is there
  Span type_span;                    // of the value of `type`; of no meaning likewise
  std::optional<std::uint32_t> use;  // which of the named nodes
  std::vector<double> params;
  std::vector<CheckedNode> children;
  std::optional<Formula> formula;  // the last child, after `children`
  std::optional<std::array<double, 13>> between;    // see Between: where the primitive itself stands, a Transform
  std::optional<std::array<double, 13>> transform;  // see Kind::Transform
  std::optional<Span> flat_translate;               // of a `translate` of two numbers, which only an outline takes
  std::optional<std::uint32_t> material;            // its own
};

}  // namespace fathom::compiler
