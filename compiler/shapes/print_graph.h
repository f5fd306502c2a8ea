// Prints the graph as text, with the names of the node table.
// Tested by: tests/compiler/graph/graph_test.cpp
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/graph/graph.h"
#include "compiler/source/source.h"

namespace fathom::compiler {

// A parameter of a node under its name in the node table: one number, or as many as its type takes.
struct NamedParam {
  std::string_view name;
  std::span<const double> values;  // part of the span given to named_params()
};
std::vector<NamedParam> named_params(Kind kind, std::span<const double> params);

// Names of the nodes in print_graph(). A number changes when an earlier node vanishes. A place, which is the node's
// type and where the scene first writes the node, stays: %sphere@6:5, and %sphere@6:5.2 for the second of that type
// from there.
enum class NodeNames { Numbers, Places };

// Prints one line per node, children before parents, only the nodes that the root reaches:
//     %0 = sphere radius=0.5              ; "ball" scene.json:6:5
//     %1 = union %0 %3
std::string print_graph(const Scene& scene, const Source& source, NodeNames names = NodeNames::Numbers);

}  // namespace fathom::compiler
