#include "runtime/measure/ray_sets.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "runtime/march/march.h"
#include "runtime/sampling/camera.h"
#include "vm/number/real.h"

namespace fathom::runtime {
namespace {

using glm::dvec3;

class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  // The standard library's distributions would differ between libraries.
  double uniform(double lo, double hi) { return lo + (hi - lo) * (static_cast<double>(engine_() >> 11) * 0x1p-53); }
  std::size_t index(std::size_t count) { return engine_() % count; }
  // Returns a direction that is uniform over the sphere.
  dvec3 direction() {
    while (true) {
      dvec3 v;
      // Separate statements, because compilers evaluate arguments in different orders.
      for (const int axis : {2, 1, 0}) v[axis] = uniform(-1, 1);
      const double squared = glm::dot(v, v);
      if (squared > 1e-4 && squared <= 1) return v / std::sqrt(squared);
    }
  }

 private:
  std::mt19937_64 engine_;
};

dvec3 to_float(dvec3 v) { return dvec3(glm::vec3(v)); }

struct Place {
  dvec3 position, normal;  // unit length, on the ray's side
};

// Returns the camera rays' hits, by the search in double.
std::vector<Place> places_of(const compiler::CompiledScene& scene, const Field& field, const std::vector<Ray>& rays) {
  const MarchResult seen = march(field, rays, {.method = Method::Certified});
  vm::Workspace workspace;
  std::vector<Place> places;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const RayHit& ray_hit = seen.ray_hits[i];
    if (ray_hit.status != RayHit::Status::Hit) continue;
    const dvec3 at = rays[i].origin + ray_hit.t * glm::normalize(rays[i].direction);
    const dvec3 gradient = vm::evaluate_surface(scene.surface, at, workspace).gradient;
    const double length = glm::length(gradient);
    if (length > 0) places.push_back({at, static_cast<double>(ray_hit.side) / length * gradient});
  }
  return places;
}

Ray bounce(const Place& place, double above, Random& random) {
  dvec3 direction = random.direction();
  if (glm::dot(direction, place.normal) < 0) direction = -direction;
  Ray ray{to_float(place.position + above * place.normal), to_float(direction)};
  ray.slope = static_cast<float>(glm::dot(direction, place.normal));
  return ray;
}

Ray graze(const Place& place, double extent, Random& random) {
  const dvec3 along = glm::normalize(glm::cross(place.normal, random.direction()));
  const double variant = random.uniform(0.2, 1) * extent, gap = vm::real::pow(10, random.uniform(-6, -2)) * extent;
  const dvec3 beside = (random.uniform(0, 1) < 0.5 ? gap : -gap) * place.normal;
  return {to_float(place.position + beside - variant * along), to_float(along)};
}

}  // namespace

double extent_of(const Field& field) { return 1e4 * static_cast<double>(field.band); }

std::vector<RaySet> make_ray_sets(const compiler::CompiledScene& scene, const Field& field, std::size_t count,
                                  std::uint64_t seed) {
  Random random(seed);
  const Camera camera(scene.camera, scene.film.width, scene.film.height);
  RaySet seen{"camera", {}}, bounced{"bounce", {}}, grazing{"grazing", {}};
  for (std::size_t i = 0; i < count; ++i) {
    const double y = random.uniform(0, scene.film.height), x = random.uniform(0, scene.film.width);
    const CameraRay ray = camera.ray(x, y);
    seen.rays.push_back({to_float(ray.origin), to_float(ray.direction)});
  }
  const std::vector<Place> places = places_of(scene, field, seen.rays);
  const double extent = extent_of(field);
  for (std::size_t i = 0; i < count && !places.empty(); ++i) {
    bounced.rays.push_back(bounce(places[random.index(places.size())], 4e-4 * extent, random));
    grazing.rays.push_back(graze(places[random.index(places.size())], extent, random));
  }
  return {seen, bounced, grazing};
}

}  // namespace fathom::runtime
