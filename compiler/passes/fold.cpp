#include <array>

#include "compiler/geometry/affine.h"
#include "compiler/graph/rewrite.h"
#include "compiler/passes/passes.h"
#include "compiler/shapes/blends.h"

namespace fathom::compiler {
namespace {

bool is_identity_transform(std::span<const double> transform) {
  constexpr std::array<double, 13> kIdentityParams = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1};
  return std::equal(kIdentityParams.begin(), kIdentityParams.end(), transform.begin());
}

// Makes an offset of `child` by `radius`.
NodeId fold_round(const Scene& in, Graph& out, NodeId id, double radius, NodeId child) {
  if (radius == 0) return child;
  const SourceLocation& origin = in.graph.origin(id);
  if (out.kind(child) == Kind::Sphere || out.kind(child) == Kind::Round) {
    const Kind kind = out.kind(child);
    const std::array<double, 1> sum = {out.params(child)[0] + radius};
    const std::vector<NodeId> grandchildren(out.children(child).begin(), out.children(child).end());
    return out.add(kind, sum, grandchildren, origin);
  }
  return out.add(Kind::Round, std::array<double, 1>{radius}, std::array<NodeId, 1>{child}, origin);
}

}  // namespace

Scene fold(const Scene& scene) {
  return rewrite(scene, [&](Graph& out, NodeId id, const std::vector<NodeId>& children) {
    const auto params = scene.graph.params(id);
    const Kind kind = scene.graph.kind(id);
    if (is_blend(kind)) {
      if (children.size() == 1) return children[0];
      if (params[0] <= kMinBlend) return out.add(hard(kind), {}, children, scene.graph.origin(id));
      return keep(scene, out, id, children);
    }
    switch (kind) {
      case Kind::Round:
        return fold_round(scene, out, id, params[0], children[0]);
      case Kind::Transform:
        if (is_identity_transform(params)) return children[0];
        break;
      case Kind::Complement:
        if (out.kind(children[0]) == Kind::Complement) return out.children(children[0])[0];
        break;
      case Kind::Scaled:
        if (params[0] == 1) return children[0];
        if (out.kind(children[0]) == Kind::Scaled) {
          const std::array<double, 1> product = {params[0] * out.params(children[0])[0]};
          const std::array<NodeId, 1> inner = {out.children(children[0])[0]};
          return out.add(Kind::Scaled, product, inner, scene.graph.origin(id));
        }
        break;
      case Kind::Union:
      case Kind::Intersection:
      case Kind::Subtraction:
      case Kind::Xor:
        if (children.size() == 1) return children[0];
        break;
      default:
        break;
    }
    return keep(scene, out, id, children);
  });
}

}  // namespace fathom::compiler
