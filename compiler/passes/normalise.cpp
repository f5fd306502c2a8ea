#include <algorithm>
#include <array>
#include <limits>

#include "compiler/passes/passes.h"
#include "compiler/passes/signs.h"
#include "compiler/shapes/bounds.h"

namespace fathom::compiler {

Scene normalise(const Scene& scene) {
  const std::vector<bool> free = only_sign_counts(scene);
  std::vector<NodeFacts> known;  // of the graph being made
  const auto lipschitz = [&](const Graph& graph, NodeId id) {
    while (known.size() <= id) known.push_back(derive_facts(graph, static_cast<NodeId>(known.size()), known));
    return known[id].lipschitz;
  };
  return rewrite(scene, [&](Graph& out, NodeId id, const std::vector<NodeId>& children) {
    if (!free[id] || !keeps_signs(scene.graph.kind(id))) return keep(scene, out, id, children);
    double steepest = 0, flattest = std::numeric_limits<double>::infinity();
    for (const NodeId child : children) {
      steepest = std::max(steepest, lipschitz(out, child));
      flattest = std::min(flattest, lipschitz(out, child));
    }
    if (steepest == flattest) return keep(scene, out, id, children);
    std::vector<NodeId> levelled;
    for (const NodeId child : children) {
      const double slope = lipschitz(out, child);
      const double factor[] = {1 / slope};
      const NodeId only[] = {child};
      levelled.push_back(slope == 1 ? child : out.add(Kind::Scaled, factor, only, out.origin(child)));
    }
    return keep(scene, out, id, levelled);
  });
}

}  // namespace fathom::compiler
