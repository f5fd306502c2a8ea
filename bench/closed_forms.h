// Rays with coordinates exact in float, and their hits of solids in closed form, in long double.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <random>

#include "runtime/march/ray.h"

namespace fathom::bench {

using Real = long double;
using Engine = std::mt19937_64;

inline glm::dvec3 to_float(glm::dvec3 v) { return glm::dvec3(glm::vec3(v)); }
inline double uniform(Engine& random, double lo, double hi) {
  return lo + (hi - lo) * std::uniform_real_distribution<double>()(random);
}
// Returns a direction, uniform on the unit sphere.
inline glm::dvec3 random_direction(Engine& random) {
  const double y = uniform(random, -1, 1), angle = uniform(random, 0, 2 * M_PI), r = std::sqrt(1 - y * y);
  return {r * std::cos(angle), y, r * std::sin(angle)};
}
// Returns a direction, uniform over the hemisphere about a unit vector.
inline glm::dvec3 random_hemisphere(Engine& random, glm::dvec3 normal) {
  const glm::dvec3 d = random_direction(random);
  return glm::dot(d, normal) < 0 ? -d : d;
}

// Returns a ray, rounded to float, that starts `away` before the origin's nearest point and passes the origin at
// distance `miss`.
inline runtime::Ray ray_past(Engine& random, double miss, double away) {
  const glm::dvec3 direction = random_direction(random);
  const glm::dvec3 aside = glm::normalize(glm::cross(direction, random_direction(random)));
  return {to_float(miss * aside - away * direction), to_float(direction)};
}

// Returns the parameter of a ray's first hit of a solid, in units of |direction|; empty for a miss. The ray starts
// outside.
using Truth = std::optional<Real> (*)(const runtime::Ray&);

// The unit sphere at the origin.
inline std::optional<Real> meet_sphere(const runtime::Ray& ray) {
  Real a = 0, b = 0, c = -1;
  for (int i = 0; i < 3; ++i) {
    const Real o = ray.origin[i], d = ray.direction[i];
    a += d * d, b += o * d, c += o * o;
  }
  const Real discriminant = b * b - a * c;
  if (discriminant < 0 || b >= 0) return std::nullopt;
  return c / (-b + std::sqrt(discriminant));
}

// The half-space y < 0.
inline std::optional<Real> meet_plane(const runtime::Ray& ray) {
  if (ray.direction.y >= 0) return std::nullopt;
  return -static_cast<Real>(ray.origin.y) / ray.direction.y;
}

// The box of half size 0.75, 0.5, 1.
inline std::optional<Real> meet_box(const runtime::Ray& ray) {
  const Real half[] = {0.75L, 0.5L, 1.0L};
  Real begin = 0, end = 1e9L;
  for (int i = 0; i < 3; ++i) {
    const Real o = ray.origin[i], d = ray.direction[i], a = (-half[i] - o) / d, b = (half[i] - o) / d;
    begin = std::max(begin, std::min(a, b));
    end = std::min(end, std::max(a, b));
  }
  if (begin > end) return std::nullopt;
  return begin;
}

// The torus of radii 0.75 and 0.25, for rays from about 5 away. Bisects the first of 20000 cells in which the sign
// changes.
inline std::optional<Real> meet_torus(const runtime::Ray& ray) {
  const auto field = [&](Real t) {
    const Real x = ray.origin.x + t * ray.direction.x, y = ray.origin.y + t * ray.direction.y,
               z = ray.origin.z + t * ray.direction.z;
    return std::hypot(std::hypot(x, z) - 0.75L, y) - 0.25L;
  };
  constexpr int kCells = 20000;
  const auto t_of = [](int i) { return 3 + 4 * static_cast<Real>(i) / kCells; };
  for (int i = 1; i <= kCells; ++i) {
    if (field(t_of(i)) > 0) continue;
    Real lo = t_of(i - 1), hi = t_of(i);
    for (int k = 0; k < 80; ++k) {
      const Real middle = (lo + hi) / 2;
      (field(middle) > 0 ? lo : hi) = middle;
    }
    return hi;
  }
  return std::nullopt;
}

}  // namespace fathom::bench
