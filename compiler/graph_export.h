// Graphs for other programs: JSON with everything that is known of each node, and drawings in the languages of
// Graphviz (dot) and Mermaid. A node that is used several times appears once; its users point to it.
// Tested by: tests/compiler/graph_export_test.cpp
#pragma once

#include <string>

#include "compiler/graph/graph.h"

namespace fathom::compiler {

// {"scene": name, "root": id, "nodes": [...]}, a node a line, children first, numbered as print_graph() does:
//     {"id": 0, "type": "sphere", "params": {"radius": 0.5}, "children": [], "name": "ball",
//      "source": {"line": 6, "column": 5}, "box": {"lo": [...], "hi": [...]}, "lipschitz": 1,
//      "outside": "exact", "inside": "exact", "certified": true}
// A number that is infinite is null, and so is a box that holds nothing or a source that is nowhere in the file.
std::string graph_json(const Scene& scene, const Source& source);

// Edges lead from a node to its operands, left to right in their order.
std::string graph_dot(const Scene& scene, const Source& source);

// The same; where there are several operands their edges are numbered, as Mermaid keeps no order.
std::string graph_mermaid(const Scene& scene, const Source& source);

}  // namespace fathom::compiler
