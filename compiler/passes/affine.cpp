#include "compiler/geometry/affine.h"

#include <array>

#include "compiler/graph/rewrite.h"
#include "compiler/passes/passes.h"

namespace fathom::compiler {

Scene affine(const Scene& scene) {
  return rewrite(scene, [&](Graph& out, NodeId id, const std::vector<NodeId>& children) {
    if (scene.graph.kind(id) != Kind::Transform || out.kind(children[0]) != Kind::Transform) {
      return keep(scene, out, id, children);
    }
    const auto outer = scene.graph.params(id), inner = out.params(children[0]);
    const auto map = compose(Affine::from_params(inner), Affine::from_params(outer)).params();
    std::array<double, 13> product{};
    std::copy(map.begin(), map.end(), product.begin());
    product[12] = outer[12] * inner[12];
    const std::array<NodeId, 1> child = {out.children(children[0])[0]};
    return out.add(Kind::Transform, product, child, scene.graph.origin(id));
  });
}

}  // namespace fathom::compiler
