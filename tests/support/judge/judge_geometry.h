// Geometry shared by the judge and brute force: parameters as vectors, distances to segments and flat polygons.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <numbers>
#include <optional>
#include <span>
#include <vector>

#include "compiler/graph/graph.h"

namespace fathom::test {

using Params = std::span<const double>;  // a node's parameters

inline constexpr double kPi = std::numbers::pi;
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

inline double radians(double degrees) { return degrees * kPi / 180; }
inline glm::dvec2 vec2_at(Params k, std::size_t first) { return {k[first], k[first + 1]}; }
inline glm::dvec3 vec3_at(Params k, std::size_t first) { return {k[first], k[first + 1], k[first + 2]}; }

// The foot of p on the line through a and b is a + t(b - a) with t = <p-a, b-a> / |b-a|^2. The nearest point of the
// segment has t clamped, since |p - a - t(b-a)|^2 is a parabola in t.
template <typename V>
double distance_to_segment(V p, V a, V b) {
  const V ab = b - a;
  const double length2 = glm::dot(ab, ab);
  const double t = length2 > 0 ? std::clamp(glm::dot(p - a, ab) / length2, 0.0, 1.0) : 0.0;
  const V nearest = t < 0.5 ? a + t * ab : b - (1 - t) * ab;
  return glm::length(p - nearest);
}

// Distance to a planar convex polygon: to the plane if p projects into the polygon (left of every edge, seen from the
// side the normal points to), else to the nearest edge. The normal is Newell's sum.
inline double distance_to_polygon(glm::dvec3 p, const std::vector<glm::dvec3>& v) {
  glm::dvec3 normal(0);
  for (std::size_t i = 0; i < v.size(); ++i) normal += glm::cross(v[i] - v[0], v[(i + 1) % v.size()] - v[0]);
  normal = glm::normalize(normal);
  bool projects_inside = true;
  double to_edge = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < v.size(); ++i) {
    const glm::dvec3 a = v[i], b = v[(i + 1) % v.size()];
    projects_inside = projects_inside && glm::dot(glm::cross(b - a, p - a), normal) >= 0;
    to_edge = std::min(to_edge, distance_to_segment(p, a, b));
  }
  return projects_inside ? std::abs(glm::dot(p - v[0], normal)) : to_edge;
}

// Outside, the nearest point of a box is p clamped to the box. Inside, the nearest face lies along one axis.
inline double distance_to_box(glm::dvec3 p, glm::dvec3 half) {
  const glm::dvec3 outside = p - glm::clamp(p, -half, half);
  if (outside != glm::dvec3(0)) return std::hypot(outside.x, outside.y, outside.z);
  return -std::min({half.x - p.x, half.x + p.x, half.y - p.y, half.y + p.y, half.z - p.z, half.z + p.z});
}

// Distance to a solid of judge_solids.cpp; nullopt for all other primitives.
std::optional<double> judge_solid(compiler::Kind kind, std::span<const double> params, glm::dvec3 p);

}  // namespace fathom::test
