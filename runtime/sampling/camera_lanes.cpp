// Compiled once for each instruction set and chosen at run time (Highway's foreach_target).
#include "runtime/sampling/camera_lanes.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "runtime/sampling/camera_lanes.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "vm/number/batch-inl.h"

HWY_BEFORE_NAMESPACE();
namespace fathom::runtime::HWY_NAMESPACE {

using Doubles = vm::HWY_NAMESPACE::RealBatch;

// As Camera::image_plane_offset() and Camera::ray().
void set_directions(const Camera& camera, std::size_t count, PinholeRows& rows) {
  const auto k = [](double value) HWY_ATTR { return Doubles::broadcast(value); };
  const glm::dvec3 right = camera.right(), up = camera.up(), forward = camera.forward();
  const glm::dvec2 size = camera.size(), half = camera.half_extent();
  for (std::size_t i = 0; i < count; i += vm::HWY_NAMESPACE::kLanesOf<double>) {
    const Doubles sx = (k(2) * Doubles::load(rows.x + i) / k(size.x) - k(1)) * k(half.x);
    const Doubles sy = (k(1) - k(2) * Doubles::load(rows.y + i) / k(size.y)) * k(half.y);
    Doubles way[3], squares = k(0);
    for (int axis = 0; axis < 3; ++axis) {
      way[axis] = k(right[axis]) * sx + k(up[axis]) * sy + k(forward[axis]);
      squares = axis == 0 ? way[0] * way[0] : squares + way[axis] * way[axis];
    }
    const Doubles inverse = k(1) / sqrt(squares);
    for (int axis = 0; axis < 3; ++axis) (way[axis] * inverse).store(rows.direction[axis] + i);
  }
}

}  // namespace fathom::runtime::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace fathom::runtime {

HWY_EXPORT(set_directions);

void set_pinhole_directions(const Camera& camera, std::size_t count, PinholeRows& rows) {
  HWY_DYNAMIC_DISPATCH(set_directions)(camera, count, rows);
}

}  // namespace fathom::runtime
#endif  // HWY_ONCE
