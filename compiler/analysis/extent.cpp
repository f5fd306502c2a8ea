#include "compiler/analysis/extent.h"

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

}  // namespace fathom::compiler
