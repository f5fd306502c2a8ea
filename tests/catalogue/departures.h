// Rays that go on from what other rays have met, as a renderer's do.
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

// The places that rays have met, and what the renderer makes of each.
struct Places {
  std::vector<Hit> hits;
  std::vector<SurfacePoint> points;
};

inline Places places(const compiler::CompiledScene& scene, const std::vector<Ray>& rays) {
  const Field field = make_field(scene);
  Places places;
  for (const Arrival& arrival : march(field, rays).arrivals) {
    if (arrival.status != Arrival::Status::Hit) continue;
    const Ray& ray = rays[arrival.id];
    const glm::dvec3 unit = glm::normalize(ray.direction);
    places.hits.push_back({ray.origin + arrival.t * unit, glm::vec3(-unit), arrival.side, arrival.width});
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

// From a place, off the surface by as much as `spawn` says, into a direction on the normal's side.
inline Ray departure(const Hit& hit, const SurfacePoint& point, glm::dvec3 direction) {
  Ray ray{spawn(hit, point, false), direction};
  ray.side = hit.side;
  ray.slope = static_cast<float>(glm::dot(glm::dvec3(point.normal), direction));
  return ray;
}

// One ray for each place, evenly over the hemisphere.
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
