#include "compiler/passes/passes.h"
#include "compiler/passes/rewrite.h"

namespace fathom::compiler {

Scene flatten(const Scene& scene) {
  return rewrite(scene, [&](Graph& out, NodeId id, const std::vector<NodeId>& children) {
    const Kind kind = scene.graph.kind(id);
    const bool associative = kind == Kind::Union || kind == Kind::Intersection;
    if (!associative && kind != Kind::Subtraction) return keep(scene, out, id, children);
    std::vector<NodeId> flat;
    for (std::size_t i = 0; i < children.size(); ++i) {
      if (out.kind(children[i]) == kind && (associative || i == 0)) {
        const auto inner = out.children(children[i]);
        flat.insert(flat.end(), inner.begin(), inner.end());
      } else {
        flat.push_back(children[i]);
      }
    }
    return out.add(kind, {}, flat, scene.graph.origin(id));
  });
}

}  // namespace fathom::compiler
