#include "compiler/analysis/extent.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "compiler/geometry/affine.h"
#include "compiler/shapes/bounds.h"

namespace fathom::compiler {
namespace {

// Returns the bounding box of a node's finite parts, given those of its children.
Box finite_part(const Graph& graph, NodeId id, const NodeFacts& known, const std::vector<Box>& parts) {
  if (known.box.finite()) return known.box;
  const std::span<const NodeId> children = graph.children(id);
  if (graph.kind(id) == Kind::Transform) {
    return image(inverse(Affine::from_params(graph.params(id))), parts[children[0]]);
  }
  Box part;
  if (!takes_own_point(graph, id)) return part;
  for (const NodeId child : children) part = unite(part, parts[child]);
  return part;
}

}  // namespace

Box extent(const Scene& scene, const std::vector<NodeFacts>& known) {
  std::vector<Box> parts(scene.graph.size());
  for (NodeId id = 0; id <= scene.root; ++id) parts[id] = finite_part(scene.graph, id, known[id], parts);
  return parts[scene.root];
}

void leave_solids(Camera& camera, const vm::Code& distance) {
  vm::Workspace workspace;
  const auto at = [&](glm::dvec3 point) { return vm::evaluate_distance(distance, point, workspace); };
  if (!camera.automatic || at(camera.position) > 0) return;
  const glm::dvec3 view = camera.target - camera.position, start = camera.position;
  const double far = glm::length(view);
  // The R3 sequence. Source: M. Roberts, The Unreasonable Effectiveness of Quasirandom Sequences, 2018.
  constexpr glm::dvec3 kStep{0.8191725133961645, 0.6710436067037893, 0.5497004779019703};
  constexpr int kPoints = 256;
  constexpr double kClear = 1e-3;  // of the way to the target
  double most = kClear * far;
  for (double reach = 0.1; reach < 20 && camera.position == start; reach *= 2) {
    for (int i = 1; i <= kPoints; ++i) {
      const glm::dvec3 unit = glm::fract(kStep * static_cast<double>(i));
      const glm::dvec3 point = start + reach * far * (2.0 * unit - 1.0);
      const double clear = at(point);
      if (!(clear > most)) continue;
      most = clear;
      camera.position = point;
    }
  }
  camera.target = camera.position + view;
}

}  // namespace fathom::compiler
