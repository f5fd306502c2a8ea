// Surfaces at the hits of rays: position, normal and material, in batches, by the surface program.
// Tested by: tests/runtime/path/surface_test.cpp
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <span>

#include "compiler/scene/compiled_scene.h"
#include "runtime/field/field.h"
#include "runtime/march/ray.h"
#include "runtime/path/surface_lanes.h"
#include "vm/interpret/evaluate.h"

namespace fathom::runtime {

// A point where a ray hit a surface.
struct Hit {
  glm::dvec3 position;             // scene units
  glm::vec3 wo;                    // unit length, back along the ray
  int side;                        // of the space the ray came through: +1 outside, -1 inside a solid
  float width;                     // of the bracket around the hit, scene units
  std::uint32_t piece = kNoPiece;  // RayHit::piece
};

struct SurfacePoint {
  glm::vec3 normal;        // unit length, into the space the ray came through; dot(normal, wo) > 0
  std::uint32_t surface;   // index into CompiledScene::surfaces
  std::uint32_t material;  // of the surface: index into CompiledScene::materials
  glm::dvec3 place;        // the hit in the coordinates of the node; set only if the surface is `placed`
  float steepness;         // length of the gradient, relative to the field's Lipschitz constant, in [0,1]
  float offset;            // distance along the normal at which a new ray starts, scene units
  // Distance, scene units from the new ray's origin, before which a ray on the hit's side of the surface meets
  // nothing: the solid is convex within this distance, and a ray that leaves a convex solid does not meet it again.
  float clear;
};

// Sets points[i], except its `place`, to the surface at hits[i] of `field`, which is the scene's or a medium's: of
// the piece that was hit, if it is known. Takes at most kSurfaceBatch hits. A gradient that is zero or not finite
// gives the normal wo.
void find_surfaces(const compiler::CompiledScene& scene, const Field& field, std::span<const Hit> hits,
                   std::span<SurfacePoint> points, vm::Workspace& workspace);

// Sets the `place` of hits on `placed` surfaces, by the field in double. At a seam, double may find another surface
// than float did. The point then belongs to that surface.
void find_object_points(const compiler::CompiledScene& scene, const Field& field, std::span<const Hit> hits,
                        std::span<SurfacePoint> points, RealScratch& scratch);
// Returns the surface at a point on or near `field`'s surface, and the point in the coordinates of the surface's
// node.
vm::SurfacePlace find_object_point(const compiler::CompiledScene& scene, const Field& field, glm::dvec3 position,
                                   RealScratch& scratch);

// Returns the surfaces of a blend at a hit of `field`, with their weights. If some surface is `placed`,
// also returns the point in the coordinates of each surface's node.
vm::SurfaceShares find_blend_weights(const compiler::CompiledScene& scene, const Field& field, const Hit& hit,
                                     RealScratch& scratch);

// Returns the origin of a ray that leaves the surface on the hit's side, or on the other side if `through`.
inline glm::dvec3 spawn_origin(const Hit& hit, const SurfacePoint& point, bool through) {
  const double along = through ? -point.offset : point.offset;
  return hit.position + along * glm::dvec3(point.normal);
}

// Sets the ray from spawn_origin() along `direction`, of unit length, without its end. In place: the stages' copies
// of whole rays would wait for the stores that have just filled them.
inline void set_spawned_ray(const Hit& hit, const SurfacePoint& point, glm::dvec3 direction, bool through, Ray& ray) {
  // Cosine below which the normal's error might let the ray meet the surface again.
  constexpr float kMinLeaving = 0x1p-6f;
  ray.origin = spawn_origin(hit, point, through);
  ray.direction = direction;
  const float cosine = glm::dot(point.normal, glm::vec3(direction));
  ray.side = through ? -hit.side : hit.side;
  ray.slope = std::abs(cosine) * point.steepness;
  const bool leaves = !through && cosine > kMinLeaving;
  ray.clear = leaves ? static_cast<double>(point.clear) : 0;
  ray.leaves = leaves ? hit.piece : kNoPiece;
}
inline Ray spawn_ray(const Hit& hit, const SurfacePoint& point, glm::dvec3 direction, bool through) {
  Ray ray;
  set_spawned_ray(hit, point, direction, through, ray);
  return ray;
}

}  // namespace fathom::runtime
