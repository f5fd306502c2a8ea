#include "runtime/path/surface.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>

#include "runtime/field/field.h"
#include "vm/program/check.h"

namespace fathom::runtime {
namespace {

// Minimum cosine between a normal and wo, so that the normal at a grazing hit still faces the ray.
constexpr float kMinCosine = 1e-4f;
// Distance from the surface at which a new ray starts, in d_f: float cannot mistake the sides there. The part of d_f
// that comes from cancellation is a loose bound, of which twice is enough.
constexpr float kOffsetErrors = 16, kMagnitudeErrors = 2;
// Maximum of that distance, in bands: 0.3 % of the subject's size. Rays that start closer than d_f are marched in
// double.
constexpr float kMaxOffset = 32;

// Share of a clear distance that is used: a ray must not begin where rounding may put the next surface.
constexpr float kTrusted = 0.98f;

// Normal that faces the ray. `exact`: the normal is the gradient's direction. Otherwise rounding or a crease turned
// the gradient away from the ray, and the normal is turned back just far enough.
struct FacingNormal {
  glm::vec3 normal;
  bool exact;
};
FacingNormal facing_normal(glm::vec3 gradient, const Hit& hit) {
  const float length = std::sqrt(glm::dot(gradient, gradient));
  if (!(length > 0 && length < INFINITY)) return {hit.wo, false};
  const glm::vec3 normal = gradient * (static_cast<float>(hit.side) / length);
  const float cosine = glm::dot(normal, hit.wo);
  if (cosine > 0) return {normal, true};
  const glm::vec3 turned = normal + (kMinCosine - cosine) * hit.wo;
  const float squared = glm::dot(turned, turned);
  return {squared > kMinCosine * kMinCosine ? turned / std::sqrt(squared) : hit.wo, false};
}

// Returns the distance from the hit within which rays that leave a convex solid meet nothing.
float clear_distance(float convex, float size, float offset, const Field& field) {
  const float error = kDistanceError * (std::max(size, std::abs(convex)) + field.cancellation);
  return std::max(0.0f, kTrusted * (convex - 2 * error) * field.inv_lipschitz - offset);
}

}  // namespace

void find_surfaces(const compiler::CompiledScene& scene, const Field& field, std::span<const Hit> hits,
                   std::span<SurfacePoint> points, vm::Workspace& workspace) {
  CHECK(hits.size() <= kSurfaceBatch && points.size() >= hits.size(), "a batch of hits is too large");
  alignas(64) std::array<float, kSurfaceBatch> x, y, z, distance, gx, gy, gz, convex;
  alignas(64) std::array<std::uint32_t, kSurfaceBatch> surface;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    x[i] = static_cast<float>(hits[i].position.x);
    y[i] = static_cast<float>(hits[i].position.y);
    z[i] = static_cast<float>(hits[i].position.z);
  }
  const vm::Points places{x.data(), y.data(), z.data()};
  const vm::SurfaceValues values{distance.data(), gx.data(), gy.data(), gz.data(), surface.data(), convex.data()};
  if (field.regions) {
    field.regions->evaluate_surface(places, hits.size(), values, workspace);
  } else {
    vm::evaluate_surface(*field.surface, places, hits.size(), values, workspace);
  }
  for (std::size_t i = 0; i < hits.size(); ++i) {
    glm::vec3 gradient{gx[i], gy[i], gz[i]};
    const float size = std::max({1.0f, std::abs(x[i]), std::abs(y[i]), std::abs(z[i])});
    const float least = kDistanceError * (kOffsetErrors * size + kMagnitudeErrors * field.cancellation);
    const float most = kMaxOffset * field.band;
    if (least > most) {
      // Coordinates this coarse give a coarse normal, perhaps of another surface.
      const vm::SurfaceValue exact = field.regions
                                         ? field.regions->evaluate_surface(hits[i].position, workspace)
                                         : vm::evaluate_surface(*field.surface, hits[i].position, workspace);
      gradient = glm::vec3(exact.gradient);
      surface[i] = exact.surface;
      convex[i] = 0;
    }
    CHECK(surface[i] < scene.surfaces.size(), "a tag of the surface program has no surface");
    const FacingNormal found = facing_normal(gradient, hits[i]);
    points[i].normal = found.normal;
    points[i].surface = surface[i];
    points[i].material = scene.surfaces[surface[i]].material;
    points[i].offset = std::max(2 * hits[i].width, std::min(least, most));
    points[i].clear = found.exact && hits[i].side > 0 && !field.far_levels.used()
                          ? clear_distance(convex[i], size, points[i].offset, field)
                          : 0;
  }
}

void find_object_points(const compiler::CompiledScene& scene, const Field& field, std::span<const Hit> hits,
                        std::span<SurfacePoint> points, RealScratch& scratch) {
  for (std::size_t i = 0; i < hits.size(); ++i) {
    if (!scene.surfaces[points[i].surface].placed) continue;
    const vm::SurfacePlace found = find_object_point(scene, field, hits[i].position, scratch);
    points[i].surface = found.surface;
    points[i].material = scene.surfaces[found.surface].material;
    points[i].place = found.place;
  }
}

vm::SurfacePlace find_object_point(const compiler::CompiledScene& scene, const Field& field, glm::dvec3 position,
                                   RealScratch& scratch) {
  vm::SurfacePlace found = field.regions ? field.regions->evaluate_place(position, scratch)
                                         : vm::evaluate_place(*field.surface, position, scratch.workspace);
  CHECK(found.surface < scene.surfaces.size(), "a tag of the surface program has no surface");
  found.place += scene.surfaces[found.surface].shift;
  return found;
}

vm::SurfaceShares find_blend_weights(const compiler::CompiledScene& scene, const Field& field, glm::dvec3 place,
                                     RealScratch& scratch) {
  const bool placed =
      std::any_of(scene.surfaces.begin(), scene.surfaces.end(), std::mem_fn(&compiler::Surface::placed));
  if (!placed) {
    if (field.regions) return field.regions->evaluate_shares(place, scratch);
    return vm::evaluate_shares(*field.surface, place, scratch.workspace);
  }
  vm::SurfaceShares shares = field.regions ? field.regions->evaluate_placed_shares(place, scratch)
                                           : vm::evaluate_placed_shares(*field.surface, place, scratch.workspace);
  for (int i = 0; i < shares.count; ++i) {
    vm::SurfaceShare& share = shares.all[static_cast<std::size_t>(i)];
    share.place += scene.surfaces[share.surface].shift;
  }
  return shares;
}

}  // namespace fathom::runtime
