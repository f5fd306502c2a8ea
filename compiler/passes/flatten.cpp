#include <algorithm>

#include "compiler/graph/rewrite.h"
#include "compiler/passes/passes.h"

namespace fathom::compiler {
namespace {

// True if a node of this kind may replace its operand number `i`, when of the same kind, by that operand's operands.
bool takes_up(Kind kind, std::size_t i) {
  return kind == Kind::Union || kind == Kind::Intersection || (kind == Kind::Subtraction && i == 0);
}

// [node] True if the node merges into its only user. A node with several users stays: otherwise a list could hold the
// node as often as there are paths to the node, and n nodes can have 2^n paths.
std::vector<bool> taken_up(const Scene& scene, const std::vector<bool>& reached) {
  std::vector<std::uint32_t> uses(scene.graph.size(), 0);
  std::vector<bool> taken(scene.graph.size(), false);
  for (NodeId id = 0; id <= scene.root; ++id) {
    if (!reached[id]) continue;
    const auto children = scene.graph.children(id);
    const Kind kind = scene.graph.kind(id);
    for (std::size_t i = 0; i < children.size(); ++i) {
      ++uses[children[i]];
      taken[children[i]] = takes_up(kind, i) && scene.graph.kind(children[i]) == kind;
    }
  }
  for (NodeId id = 0; id < scene.graph.size(); ++id) taken[id] = taken[id] && uses[id] == 1;
  return taken;
}

}  // namespace

Scene flatten(const Scene& scene) {
  const std::vector<bool> reached = reachable(scene), taken = taken_up(scene, reached);
  Scene out;
  std::vector<NodeId> rebuilt(scene.graph.size(), 0), flat, pending;
  for (NodeId id = 0; id <= scene.root; ++id) {
    if (!reached[id] || taken[id]) continue;
    const auto push = [&](NodeId node) {
      const auto children = scene.graph.children(node);
      pending.insert(pending.end(), children.rbegin(), children.rend());
    };
    flat.clear();
    for (push(id); !pending.empty();) {
      const NodeId next = pending.back();
      pending.pop_back();
      if (taken[next]) {
        push(next);
      } else {
        flat.push_back(rebuilt[next]);
      }
    }
    rebuilt[id] = keep(scene, out.graph, id, flat);
  }
  out.root = rebuilt[scene.root];
  return out;
}

}  // namespace fathom::compiler
