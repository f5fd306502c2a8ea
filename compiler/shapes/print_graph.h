// The graph as text, with the names of the node table.
// Tested by: tests/compiler/graph/graph_test.cpp
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/graph/graph.h"
#include "compiler/source/source.h"

namespace fathom::compiler {

// A parameter of a node as its row in the node table names it: one number, or as many as its type takes.
struct NamedParam {
  std::string_view name;
  std::span<const double> values;  // into the span given to named_params()
};
std::vector<NamedParam> named_params(Kind kind, std::span<const double> params);

// How print_graph() calls the nodes. A number changes when a node before it goes; a place, the node's type and where
// it was first written, stays: %sphere@6:5, the second of that type from there %sphere@6:5.2.
enum class NodeNames { Numbers, Places };

// One line a node, children before parents, only what the root reaches:
//     %0 = sphere radius=0.5              ; "ball" scene.json:6:5
//     %1 = union %0 %3
std::string print_graph(const Scene& scene, const Source& source, NodeNames names = NodeNames::Numbers);

}  // namespace fathom::compiler
