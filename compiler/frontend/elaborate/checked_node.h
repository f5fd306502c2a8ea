// Node of a scene file after checking, with parameters in the node table's order and names replaced by numbers.
// check_node.h makes checked nodes, and build.h builds the graph from them.
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
  Span span;                         // the whole record
  std::string name;                  // the property `name`, otherwise the name under `nodes`; "" without either
  std::string word;                  // the value of `use`, otherwise of `type`
  Kind kind = Kind::Union;           // meaningless if `use` is set
  Span type_span;                    // the value of `type`; meaningless if `use` is set
  std::optional<std::uint32_t> use;  // number of the named node
  std::vector<double> params;
  std::vector<CheckedNode> children;
  std::optional<Formula> formula;                   // becomes the last child, after `children`
  std::optional<std::array<double, 13>> between;    // Transform from two end points, see Between
  std::optional<std::array<double, 13>> transform;  // see Kind::Transform
  std::optional<Span> flat_translate;               // `translate` of two numbers, valid for outlines only
  std::optional<std::uint32_t> material;            // the node's own
};

}  // namespace fathom::compiler
