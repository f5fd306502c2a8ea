#include "runtime/mesh/mesh_box.h"

#include <algorithm>

namespace fathom::runtime {

std::variant<MeshBox, NoMeshBox> mesh_box(const compiler::CompiledScene& scene,
                                          const std::optional<compiler::Box>& wanted) {
  MeshBox chosen{scene.bound, false};
  if (wanted) {
    chosen.box = intersect(*wanted, scene.bound);
    const compiler::Box outside = unite(*wanted, scene.bound);
    chosen.is_clipped = outside.lo != wanted->lo || outside.hi != wanted->hi;
  }
  if (chosen.box.empty()) return NoMeshBox::Empty;
  if (!chosen.box.finite()) return NoMeshBox::Endless;
  const glm::dvec3 size = chosen.box.hi - chosen.box.lo;
  if (!(std::min({size.x, size.y, size.z}) > 0)) return NoMeshBox::Empty;
  return chosen;
}

MeshOptions mesh_options(const MeshBox& box, std::optional<double> tolerance, int resolution) {
  MeshOptions options;
  options.tolerance = tolerance.value_or(tolerance_of(box.box, resolution));
  options.deviation = tolerance ? options.tolerance : fine_deviation(options.tolerance);
  options.is_clipped = box.is_clipped;
  return options;
}

}  // namespace fathom::runtime
