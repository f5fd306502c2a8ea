#include "runtime/measure/maps.h"

#include <cmath>
#include <limits>

#include "runtime/march/march.h"
#include "runtime/sampling/camera.h"

namespace fathom::runtime {
namespace {

constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();

// Returns the error in units in the last place of `truth` as a float.
float units_apart(double depth, double truth) {
  const float rounded = static_cast<float>(truth);
  const float unit = std::nextafter(rounded, std::numeric_limits<float>::infinity()) - rounded;
  return static_cast<float>(std::abs(depth - truth) / static_cast<double>(unit));
}

float depth_error(const RayHit& ray_hit, const RayHit& truth) {
  const bool hit = ray_hit.status == RayHit::Status::Hit, expected = truth.status == RayHit::Status::Hit;
  if (hit && expected) return units_apart(ray_hit.t, truth.t);
  return hit || expected ? std::numeric_limits<float>::infinity() : kNothing;
}

}  // namespace

PixelMaps measure_maps(const compiler::CompiledScene& scene, const Field& field, int width, int height) {
  const Camera camera(scene.camera, width, height);
  std::vector<Ray> rays;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const CameraRay ray = camera.ray(x + 0.5, y + 0.5);
      rays.push_back({ray.origin, ray.direction});
    }
  }
  const MarchResult seen = march(field, rays), truth = march(field, rays, {.method = Method::Certified});
  PixelMaps maps{width, height, {}, {}, {}};
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const RayHit& ray_hit = seen.ray_hits[i];
    maps.evaluations.push_back(static_cast<float>(ray_hit.evaluations));
    maps.in_double.push_back(static_cast<float>(ray_hit.certified));
    maps.depth_error.push_back(depth_error(ray_hit, truth.ray_hits[i]));
  }
  return maps;
}

}  // namespace fathom::runtime
