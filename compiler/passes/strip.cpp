#include "compiler/graph/rewrite.h"
#include "compiler/passes/passes.h"

namespace fathom::compiler {

Scene strip(const Scene& scene) {
  return rewrite(scene, [&](Graph& out, NodeId id, const std::vector<NodeId>& children) {
    return scene.graph.kind(id) == Kind::Paint ? children[0] : keep(scene, out, id, children);
  });
}

}  // namespace fathom::compiler
