// Graphs for other programs: JSON with all facts known about each node, and drawings in the languages of Graphviz
// (dot) and Mermaid. A node with several users appears once, and its users point to it.
// Tested by: tests/compiler/graph_export_test.cpp
#pragma once

#include <string>

#include "compiler/graph/graph.h"

namespace fathom::compiler {

// {"scene": name, "root": id, "nodes": [...]}, one node per line, children first, numbered like print_graph():
//     {"id": 0, "type": "sphere", "params": {"radius": 0.5}, "children": [], "name": "ball",
//      "source": {"line": 6, "column": 5}, "box": {"lo": [...], "hi": [...]}, "lipschitz": 1,
//      "outside": "exact", "inside": "exact", "certified": true}
// An infinite number, an empty box and a node without a place in the source are null.
std::string graph_json(const Scene& scene, const Source& source);

// Edges lead from a node to its operands, from left to right in their order.
std::string graph_dot(const Scene& scene, const Source& source);

// Like graph_dot(), but the edges to several operands are numbered, because Mermaid does not keep their order.
std::string graph_mermaid(const Scene& scene, const Source& source);

}  // namespace fathom::compiler
