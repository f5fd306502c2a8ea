// Hits -> what shading needs to know of the place: position, normal, material. In batches, through the surface
// program. Tested by: tests/runtime/path/surface_test.cpp
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
#include "vm/interpret/evaluate.h"

namespace fathom::runtime {

// A place where a ray met the surface.
struct Hit {
  glm::dvec3 position;  // scene units
  glm::vec3 wo;         // unit length, back along the ray
  int side;             // of the space the ray came through: +1 outside, -1 inside a solid
  float width;          // of the bracket round the hit, scene units
};

struct SurfacePoint {
  glm::vec3 normal;        // unit length, into the space the ray came through; dot(normal, wo) > 0
  std::uint32_t surface;   // index into CompiledScene::surfaces
  std::uint32_t material;  // its: index into CompiledScene::materials
  glm::dvec3 place;        // the hit in the coordinates of the node, where the surface is `placed`; else no place
  float offset;            // how far along the normal a new ray has to start, scene units
  // A ray that leaves into the space the ray came through meets nothing before this, scene units from where it
  // starts: the part of the solid nearer than that is convex, and what leaves a convex solid does not come back to
  // it.
  float clear;
};

inline constexpr std::size_t kSurfaceBatch = 256;

// points[i] describes hits[i] of `field`, the scene's or a medium's, all but SurfacePoint::place; at most
// kSurfaceBatch of them. Where the gradient is zero or not a number the normal is wo.
void find_surfaces(const compiler::CompiledScene& scene, const Field& field, std::span<const Hit> hits,
                   std::span<SurfacePoint> points, vm::Workspace& workspace);

// Where hits on `placed` surfaces are in the coordinates of their nodes, by the field in double. At a seam that may
// find another surface than float did: then the point is of that one.
void find_object_points(const compiler::CompiledScene& scene, const Field& field, std::span<const Hit> hits,
                 std::span<SurfacePoint> points, RealScratch& scratch);
// The surface at a place of `field`'s surface, or nearest to it, and that place in the coordinates of its node.
vm::SurfacePlace find_object_point(const compiler::CompiledScene& scene, const Field& field, glm::dvec3 position,
                            RealScratch& scratch);

// The surfaces that have a share in a place of `field`'s surface, with their places where some surface is `placed`.
vm::SurfaceShares find_blend_weights(const compiler::CompiledScene& scene, const Field& field, glm::dvec3 place,
                              RealScratch& scratch);

// Where a ray starts that leaves the surface into the space the ray came through, or past the surface into the other.
inline glm::dvec3 spawn_origin(const Hit& hit, const SurfacePoint& point, bool through) {
  const double along = through ? -point.offset : point.offset;
  return hit.position + along * glm::dvec3(point.normal);
}

// The ray that leaves from there into `direction`, of unit length. Here, so that it stays in registers.
inline Ray spawn_ray(const Hit& hit, const SurfacePoint& point, glm::dvec3 direction, bool through) {
  // Nearly along the surface it might meet it again by the normal's error.
  constexpr float kMinLeaving = 0x1p-6f;
  Ray ray{spawn_origin(hit, point, through), direction};
  const float cosine = glm::dot(point.normal, glm::vec3(direction));
  ray.side = through ? -hit.side : hit.side;
  ray.slope = std::abs(cosine);
  ray.clear = !through && cosine > kMinLeaving ? point.clear : 0;
  return ray;
}

}  // namespace fathom::runtime
