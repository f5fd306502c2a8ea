// The loop of every pass: rebuilds the nodes that the root reaches, children before parents, by one function.
#pragma once

#include <map>
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

// Returns a node of a graph with what it reaches, in time proportional to that.
inline Scene part_of(const Graph& graph, NodeId root) {
  std::map<NodeId, NodeId> rebuilt;  // children before parents
  std::vector<NodeId> waiting = {root}, children;
  while (!waiting.empty()) {
    const NodeId id = waiting.back();
    waiting.pop_back();
    if (!rebuilt.emplace(id, 0).second) continue;
    for (const NodeId child : graph.children(id)) waiting.push_back(child);
  }
  Scene out;
  for (auto& [id, copy] : rebuilt) {
    children.clear();
    for (const NodeId child : graph.children(id)) children.push_back(rebuilt.at(child));
    copy = out.graph.add(graph.kind(id), graph.params(id), children, graph.origin(id));
  }
  out.root = rebuilt.at(root);
  return out;
}

}  // namespace fathom::compiler
