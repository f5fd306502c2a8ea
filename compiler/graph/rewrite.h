// The loop of every pass: rebuilds the nodes that the root reaches, children before parents, by one function.
#pragma once

#include <vector>

#include "compiler/graph/graph.h"

namespace fathom::compiler {

// [node] True if the root reaches the node.
inline std::vector<bool> reachable(const Graph& graph, NodeId root) {
  std::vector<bool> reached(graph.size(), false);
  reached[root] = true;
  for (NodeId id = root + 1; id-- > 0;) {  // parents come after their children
    if (!reached[id]) continue;
    for (NodeId child : graph.children(id)) reached[child] = true;
  }
  return reached;
}
inline std::vector<bool> reachable(const Scene& scene) { return reachable(scene.graph, scene.root); }

// make(out, id, children) returns the node of `out` that replaces node `id` of `in`. `children` are the rebuilt
// children of `id`.
template <class Make>
Scene rewrite(const Scene& in, const Make& make) {
  Scene out;
  const std::vector<bool> reached = reachable(in);
  std::vector<NodeId> rebuilt(in.graph.size(), 0), children;
  for (NodeId id = 0; id <= in.root; ++id) {
    if (!reached[id]) continue;
    children.clear();
    for (NodeId child : in.graph.children(id)) children.push_back(rebuilt[child]);
    rebuilt[id] = make(out.graph, id, children);
  }
  out.root = rebuilt[in.root];
  return out;
}

// Adds the node unchanged, with its rebuilt children.
inline NodeId keep(const Scene& in, Graph& out, NodeId id, const std::vector<NodeId>& children) {
  return out.add(in.graph.kind(id), in.graph.params(id), children, in.graph.origin(id));
}

}  // namespace fathom::compiler
