// Rays at random whose numbers are exact in float, the true distances along them to solids of closed form, and what
// marching makes of the two.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <random>
#include <vector>

#include "runtime/march.h"

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

// A ray that passes the origin at distance `miss`, from `away` in front of it.
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

inline Real torus_field(const Ray& ray, Real t) {
  const Real x = ray.origin.x + t * ray.direction.x, y = ray.origin.y + t * ray.direction.y,
             z = ray.origin.z + t * ray.direction.z;
  const Real q = std::sqrt(x * x + z * z) - 1;
  return std::sqrt(q * q + y * y) - 0.25L;
}

// Sphere tracing in long double with steps of at least 1e-5, and bisection across a change of sign.
inline Real torus_distance(const Ray& ray) {
  for (Real t = 0; t < 12;) {
    const Real step = std::max(std::abs(torus_field(ray, t)), 1e-5L);
    if (torus_field(ray, t + step) <= 0) {
      Real lo = t, hi = t + step;
      for (int i = 0; i < 64; ++i) (torus_field(ray, (lo + hi) / 2) > 0 ? lo : hi) = (lo + hi) / 2;
      return lo;
    }
    t += step;
  }
  return -1;
}

using Truth = std::function<Real(const Ray&)>;  // distance to the first surface, negative for a miss

struct Judgement {
  int hits = 0, false_hits = 0, false_misses = 0, invalid = 0;
  std::vector<double> errors;  // sorted
  double p99() const { return errors.at(errors.size() * 99 / 100); }
  double worst() const { return errors.back(); }
};

inline Judgement judge(const MarchResult& result, const std::vector<Ray>& rays, const Truth& truth) {
  Judgement judgement;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Arrival& arrival = result.arrivals[i];
    const Real expected = truth(rays[i]);
    const bool hit = arrival.status == Arrival::Status::Hit;
    judgement.invalid += arrival.status == Arrival::Status::Invalid;
    judgement.hits += hit;
    judgement.false_hits += hit && expected < 0;
    judgement.false_misses += !hit && expected >= 0;
    if (hit && expected >= 0) judgement.errors.push_back(static_cast<double>(std::abs(arrival.t - expected)));
  }
  std::sort(judgement.errors.begin(), judgement.errors.end());
  return judgement;
}

}  // namespace fathom::runtime
