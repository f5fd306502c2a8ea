// Compiled once for each instruction set and chosen at run time (Highway's foreach_target).
#include "runtime/path/surface_lanes.h"

#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "runtime/path/surface_lanes.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "runtime/sampling/warp-inl.h"

HWY_BEFORE_NAMESPACE();
namespace fathom::runtime::HWY_NAMESPACE {

using FloatMask = vm::HWY_NAMESPACE::BatchMask;

// Minimum cosine between a normal and wo, so that the normal at a grazing hit still faces the ray.
constexpr float kMinCosine = 1e-4f;
// Share of a clear distance that is used: a ray must not begin where rounding may put the next surface.
constexpr float kTrusted = 0.98f;

HWY_INLINE Vectors load(const float (&rows)[3][kSurfaceBatch], std::size_t i) {
  return {Floats::load(rows[0] + i), Floats::load(rows[1] + i), Floats::load(rows[2] + i)};
}
HWY_INLINE Vectors select(FloatMask m, Vectors a, Vectors b) {
  return {select(m, a.x, b.x), select(m, a.y, b.y), select(m, a.z, b.z)};
}

// Normal that faces the ray. `exact`: the normal is the gradient's direction. Otherwise rounding or a crease turned
// the gradient away from the ray, and the normal is turned back just far enough. `length`: of the gradient, 0 if it
// is not finite.
struct FacingNormal {
  Vectors normal;
  FloatMask exact;
  Floats length;
};
HWY_INLINE FacingNormal facing_normal(Vectors gradient, Vectors wo, Floats side) {
  const Floats length = sqrt(dot(gradient, gradient));
  const FloatMask valid = (length > number(0)) & (length < number(INFINITY));
  const Vectors normal = gradient * (side / length);
  const Floats cosine = dot(normal, wo);
  const FloatMask exact = valid & (cosine > number(0));
  const Vectors turned = normal + wo * (number(kMinCosine) - cosine);
  const Floats squared = dot(turned, turned), turned_length = sqrt(squared);
  const Vectors unit = {turned.x / turned_length, turned.y / turned_length, turned.z / turned_length};
  const FloatMask turns = valid & (squared > number(kMinCosine * kMinCosine));
  return {select(exact, normal, select(turns, unit, wo)), exact, select(valid, length, number(0))};
}

// Returns the factor on the offset from a surface at which the field is flatter than its constant.
HWY_INLINE Floats flatness_factor(Floats steepness, const Field& field) {
  if (!field.cells) return number(1);
  const Floats flatness = number(1) / max(steepness, number(1 / kMaxFlatness));
  return select(steepness > number(0), flatness, number(1));
}

// Returns the distance from the hit within which rays that leave a convex solid meet nothing.
HWY_INLINE Floats clear_distance(Floats convex, Floats size, Floats offset, const Field& field) {
  const Floats error = number(kDistanceError) * (max(size, abs(convex)) + number(field.cancellation));
  const Floats trusted = number(kTrusted) * (convex - number(2) * error) * number(field.inv_lipschitz) - offset;
  return max(trusted, number(0));
}

void set_geometry(const Field& field, std::size_t count, SurfaceRows& rows) {
  const Floats most = number(kMaxOffset * field.band);
  const FloatMask may_be_clear = number(field.far_levels.used() || field.cells ? 0 : 1) > number(0);
  for (std::size_t i = 0; i < count; i += vm::HWY_NAMESPACE::kLanes) {
    const Floats side = Floats::load(rows.side + i), size = Floats::load(rows.size + i);
    const FacingNormal found = facing_normal(load(rows.gradient, i), load(rows.wo, i), side);
    const Floats least =
        number(kDistanceError) * (number(kOffsetErrors) * size + number(kMagnitudeErrors * field.cancellation));
    const Floats steepness = min(found.length * Floats::load(rows.inverse_slope + i), number(1));
    const Floats far_enough = min(least * flatness_factor(steepness, field), most);
    const Floats offset = max(far_enough, number(2) * Floats::load(rows.width + i));
    const Floats clear = clear_distance(Floats::load(rows.convex + i), size, offset, field);
    found.normal.x.store(rows.normal[0] + i);
    found.normal.y.store(rows.normal[1] + i);
    found.normal.z.store(rows.normal[2] + i);
    offset.store(rows.offset + i);
    steepness.store(rows.steepness + i);
    select(found.exact & (side > number(0)) & may_be_clear, clear, number(0)).store(rows.clear + i);
  }
}

}  // namespace fathom::runtime::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace fathom::runtime {

HWY_EXPORT(set_geometry);

void set_surface_geometry(const Field& field, std::size_t count, SurfaceRows& rows) {
  HWY_DYNAMIC_DISPATCH(set_geometry)(field, count, rows);
}

}  // namespace fathom::runtime
#endif  // HWY_ONCE
