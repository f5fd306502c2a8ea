#include <algorithm>

#include "compiler/passes/containment.h"
#include "compiler/passes/passes.h"
#include "compiler/passes/signs.h"

namespace fathom::compiler {
namespace {

class Culling {
 public:
  explicit Culling(const Scene& scene) : scene_(scene), free_(only_sign_counts(scene)) {}

  NodeId make(Graph& out, NodeId id, const std::vector<NodeId>& children) {
    const Kind kind = scene_.graph.kind(id);
    std::vector<NodeId> kept = children;
    if (free_[id] && children.size() > 1 && children.size() <= Containment::kLongestList) {
      if (kind == Kind::Union) kept = without_hidden(out, children);
      if (kind == Kind::Subtraction) kept = without_idle_cuts(out, children);
      if (kind == Kind::Intersection) kept = containment_.without_idle_limits(out, children);
    }
    if (kept.size() == 1 && children.size() > 1) return kept[0];
    return out.add(kind, scene_.graph.params(id), kept, scene_.graph.origin(id));
  }

 private:
  // Removes the arms of a union that lie wholly inside another arm, which never show.
  std::vector<NodeId> without_hidden(const Graph& graph, const std::vector<NodeId>& arms) {
    std::vector<NodeId> hidden;
    for (const Containment::Redundancy& pair : containment_.hidden_arms(graph, arms)) hidden.push_back(pair.arm);
    const std::vector<NodeId> kept = without(arms, hidden);
    return kept.empty() ? arms : kept;
  }

  // Removes the cuts that do not reach the base.
  std::vector<NodeId> without_idle_cuts(const Graph& graph, const std::vector<NodeId>& operands) {
    std::vector<NodeId> kept =
        without({operands.begin() + 1, operands.end()}, containment_.idle_cuts(graph, operands));
    kept.insert(kept.begin(), operands[0]);
    return kept;
  }

  // Returns `all` without `some`, which are in the order of `all`.
  static std::vector<NodeId> without(const std::vector<NodeId>& all, const std::vector<NodeId>& some) {
    std::vector<NodeId> kept;
    auto next = some.begin();
    for (const NodeId id : all) {
      if (next != some.end() && *next == id) {
        ++next;
      } else {
        kept.push_back(id);
      }
    }
    return kept;
  }

  const Scene& scene_;
  const std::vector<bool> free_;
  Containment containment_;  // of the graph being made
};

}  // namespace

Scene cull(const Scene& scene) {
  Culling culling(scene);
  return rewrite(scene, [&](Graph& out, NodeId id, const std::vector<NodeId>& children) {
    return culling.make(out, id, children);
  });
}

}  // namespace fathom::compiler
