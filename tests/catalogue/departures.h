// Rays that start where other rays hit, as a renderer's do.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <glm/geometric.hpp>
#include <span>
#include <vector>

#include "runtime/path/surface.h"
#include "tests/runtime/rays.h"
#include "tests/runtime/scenes.h"

namespace fathom::catalogue {

using namespace runtime;

// Hits of rays, and the surface points that the renderer computes from them.
struct Places {
  std::vector<Hit> hits;
  std::vector<SurfacePoint> points;
};

inline Places places(const compiler::CompiledScene& scene, const std::vector<Ray>& rays) {
  const Field field = make_field(scene);
  Places places;
  for (const RayHit& ray_hit : march(field, rays).ray_hits) {
    if (ray_hit.status != RayHit::Status::Hit) continue;
    const Ray& ray = rays[ray_hit.id];
    const glm::dvec3 unit = glm::normalize(ray.direction);
    places.hits.push_back({ray.origin + ray_hit.t * unit, glm::vec3(-unit), ray_hit.side, ray_hit.width});
  }
  places.points.resize(places.hits.size());
  vm::Workspace workspace;
  for (std::size_t first = 0; first < places.hits.size(); first += kSurfaceBatch) {
    const std::size_t count = std::min(kSurfaceBatch, places.hits.size() - first);
    find_surfaces(scene, field, std::span(places.hits).subspan(first, count),
                  std::span(places.points).subspan(first, count), workspace);
  }
  return places;
}

// Ray that leaves a hit in a direction on the normal's side. Its origin is offset from the surface by spawn_origin().
inline Ray departure(const Hit& hit, const SurfacePoint& point, glm::dvec3 direction) {
  Ray ray{spawn_origin(hit, point, false), direction};
  ray.side = hit.side;
  ray.slope = static_cast<float>(glm::dot(glm::dvec3(point.normal), direction));
  return ray;
}

// One ray per hit, in directions uniform over the hemisphere.
inline std::vector<Ray> departures(const Places& places, Random& random) {
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < places.hits.size(); ++i) {
    glm::dvec3 direction = random.direction();
    if (glm::dot(direction, glm::dvec3(places.points[i].normal)) < 0) direction = -direction;
    rays.push_back(departure(places.hits[i], places.points[i], direction));
  }
  return rays;
}

}  // namespace fathom::catalogue
