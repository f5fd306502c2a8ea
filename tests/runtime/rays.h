// Random rays with coordinates exact in float, their true distances to solids of closed form, and the errors of hits.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <random>
#include <vector>

#include "runtime/march/march.h"

namespace fathom::runtime {

using Real = long double;

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double uniform(double lo, double hi) { return std::uniform_real_distribution<double>(lo, hi)(engine_); }
  glm::dvec3 direction() {
    const double z = uniform(-1, 1), angle = uniform(0, 2 * M_PI), r = std::sqrt(1 - z * z);
    return {r * std::cos(angle), r * std::sin(angle), z};
  }

 private:
  std::mt19937_64 engine_;
};

inline glm::dvec3 to_float(glm::dvec3 v) { return glm::dvec3(glm::vec3(v)); }

// A ray that passes the origin at distance `miss`, and starts `away` before its nearest point.
inline Ray aimed(Random& random, double miss, double away) {
  const glm::dvec3 d = random.direction();
  const glm::dvec3 aside = glm::normalize(glm::cross(d, random.direction()));
  return {to_float(miss * aside - away * d), to_float(d)};
}

inline Real sphere_distance(const Ray& ray) {
  Real a = 0, b = 0, c = -1;
  for (int i = 0; i < 3; ++i) {
    const Real o = ray.origin[i], d = ray.direction[i];
    a += d * d;
    b += o * d;
    c += o * o;
  }
  const Real discriminant = b * b - a * c;
  if (discriminant < 0) return -1;
  const Real root = std::sqrt(discriminant);
  return c < 0 ? (-b + root) / a : (-b - root) / a;
}

inline Real box_distance(const Ray& ray) {
  const Real half[] = {0.75L, 0.5L, 1.0L};
  Real begin = -1e30L, end = 1e30L;
  for (int i = 0; i < 3; ++i) {
    const Real a = (-half[i] - ray.origin[i]) / ray.direction[i], b = (half[i] - ray.origin[i]) / ray.direction[i];
    begin = std::max(begin, std::min(a, b));
    end = std::min(end, std::max(a, b));
  }
  if (begin > end || end < 0) return -1;
  return begin >= 0 ? begin : end;
}

inline Real plane_distance(const Ray& ray) { return -static_cast<Real>(ray.origin.y) / ray.direction.y; }

inline Real torus_field(const Ray& ray, Real t, Real major, Real minor) {
  const Real x = ray.origin.x + t * ray.direction.x, y = ray.origin.y + t * ray.direction.y,
             z = ray.origin.z + t * ray.direction.z;
  const Real q = std::sqrt(x * x + z * z) - major;
  return std::sqrt(q * q + y * y) - minor;
}

// Sphere tracing in long double, on either side, with steps of at least 1e-5 and bisection across a change of sign.
inline Real ring_distance(const Ray& ray, Real major, Real minor, Real end = 12) {
  const Real side = torus_field(ray, 0, major, minor) < 0 ? -1 : 1;
  const auto field = [&](Real t) { return side * torus_field(ray, t, major, minor); };
  for (Real t = 0; t < end;) {
    const Real step = std::max(field(t), 1e-5L);
    if (field(t + step) <= 0) {
      Real lo = t, hi = t + step;
      for (int i = 0; i < 64; ++i) (field((lo + hi) / 2) > 0 ? lo : hi) = (lo + hi) / 2;
      return lo;
    }
    t += step;
  }
  return -1;
}

inline Real torus_distance(const Ray& ray) { return ring_distance(ray, 1, 0.25L); }

// Rays that hit the unit sphere, uniform over its disc, starting `away` before it.
inline std::vector<Ray> rays_at_sphere(int count, double away) {
  Random random(1);
  std::vector<Ray> rays;
  for (int i = 0; i < count; ++i) rays.push_back(aimed(random, std::sqrt(random.uniform(0, 1)), away));
  return rays;
}

// Scenes of these solids.
inline const char* const kSphere = R"("objects": [{"type": "sphere", "radius": 1}])";
inline const char* const kBox = R"("objects": [{"type": "box", "half_size": [0.75, 0.5, 1]}])";
inline const char* const kPlane = R"("objects": [{"type": "plane", "normal": [0, 1, 0]}])";
inline const char* const kTorus = R"("objects": [{"type": "torus", "major_radius": 1, "minor_radius": 0.25}])";

using Truth = std::function<Real(const Ray&)>;  // distance to the first surface, negative for a miss

// Results of rays compared with the truth.
struct Judgement {
  int rays = 0, hits = 0, false_hits = 0, false_misses = 0, invalid = 0, exhausted = 0;
  std::vector<double> errors;  // of the true hits, scene units, sorted

  void note(bool hit, double t, Real expected) {
    ++rays;
    hits += hit;
    false_hits += hit && expected < 0;
    false_misses += !hit && expected >= 0;
    if (hit && expected >= 0) errors.push_back(static_cast<double>(std::abs(t - expected)));
  }
  double quantile(double share) const {
    return errors.at(static_cast<std::size_t>(share * static_cast<double>(errors.size() - 1)));
  }
  double p50() const { return quantile(0.5); }
  double p99() const { return quantile(0.99); }
  double worst() const { return errors.back(); }
  int wrong() const { return false_hits + false_misses + invalid; }
};

inline Judgement judge(const MarchResult& result, const std::vector<Ray>& rays, const Truth& truth) {
  Judgement judgement;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const RayHit& ray_hit = result.ray_hits[i];
    judgement.invalid += ray_hit.status == RayHit::Status::Invalid;
    judgement.note(ray_hit.status == RayHit::Status::Hit, ray_hit.t, truth(rays[i]));
  }
  judgement.exhausted = static_cast<int>(result.counters.exhausted);
  std::sort(judgement.errors.begin(), judgement.errors.end());
  return judgement;
}

}  // namespace fathom::runtime
