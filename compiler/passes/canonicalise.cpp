#include <algorithm>
#include <array>

#include "compiler/graph/rewrite.h"
#include "compiler/passes/passes.h"
#include "compiler/shapes/node_table.h"

namespace fathom::compiler {

Scene canonicalise(const Scene& scene) {
  return rewrite(scene, [&](Graph& out, NodeId id, const std::vector<NodeId>& children) {
    const Kind kind = scene.graph.kind(id);
    if (spec(kind).commutes) {
      const std::array<NodeId, 2> operands = {std::min(children[0], children[1]), std::max(children[0], children[1])};
      return out.add(kind, {}, operands, scene.graph.origin(id));
    }
    if (kind != Kind::Union && kind != Kind::Intersection && kind != Kind::Subtraction) {
      return keep(scene, out, id, children);
    }
    std::vector<NodeId> operands = children;
    const auto first = operands.begin() + (kind == Kind::Subtraction ? 1 : 0);
    std::sort(first, operands.end());
    operands.erase(std::unique(first, operands.end()), operands.end());
    if (operands.size() == 1) return operands[0];
    return out.add(kind, {}, operands, scene.graph.origin(id));
  });
}

}  // namespace fathom::compiler
