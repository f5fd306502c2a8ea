// Distances in closed form, in long double, of the solids whose usual formulas are wrong or fail: the truth of rows
// F1, F8 to F11 and of the normals. All solids are centred, with y as their axis, as in the scene format.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace fathom::catalogue {

using Vec2 = glm::vec<2, long double>;
using Vec3 = glm::vec<3, long double>;
using Distance = std::function<long double(const Vec3&)>;

// Signed distance to the rectangle [-x,x] x [-y,y] in the half-plane (distance from the axis, y).
inline long double rectangle_distance(Vec2 p, Vec2 half) {
  const long double x = std::abs(p.x) - half.x, y = std::abs(p.y) - half.y;
  return std::hypot(std::max(x, 0.0L), std::max(y, 0.0L)) + std::min(std::max(x, y), 0.0L);
}

inline Vec2 half_plane(const Vec3& p) { return {std::hypot(p.x, p.z), p.y}; }

inline long double box_distance(const Vec3& p, const Vec3& half) {
  const long double x = std::abs(p.x) - half.x, y = std::abs(p.y) - half.y, z = std::abs(p.z) - half.z;
  return std::hypot(std::max(x, 0.0L), std::max(y, 0.0L), std::max(z, 0.0L)) + std::min(std::max({x, y, z}), 0.0L);
}

template <class Vec>
long double segment_distance(const Vec& p, const Vec& a, const Vec& b) {
  const long double along = glm::dot(p - a, b - a) / glm::dot(b - a, b - a);
  return glm::length(p - a - std::clamp(along, 0.0L, 1.0L) * (b - a));
}

// Signed distance to the cone with radius `bottom` at y = -h and `top` at y = h.
inline long double cone_distance(const Vec3& p, long double bottom, long double top, long double h) {
  const Vec2 q = half_plane(p), low(bottom, -h), high(top, h);
  long double nearest = segment_distance(q, low, high);
  if (bottom > 0) nearest = std::min(nearest, segment_distance(q, Vec2(0, -h), low));
  if (top > 0) nearest = std::min(nearest, segment_distance(q, Vec2(0, h), high));
  const bool within = std::abs(q.y) < h && q.x < bottom + (top - bottom) * (q.y + h) / (2 * h);
  return within ? -nearest : nearest;
}

// Distance to a flat convex polygon of thickness 0, corners in order.
template <std::size_t n>
long double sheet_distance(const Vec3& p, const std::array<Vec3, n>& corners) {
  const Vec3 normal = glm::normalize(glm::cross(corners[1] - corners[0], corners[2] - corners[0]));
  bool over = true;
  long double nearest = 1e30L;
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3 &a = corners[i], &b = corners[(i + 1) % n];
    over &= glm::dot(glm::cross(b - a, p - a), normal) >= 0;
    nearest = std::min(nearest, segment_distance(p, a, b));
  }
  return over ? std::abs(glm::dot(p - corners[0], normal)) : nearest;
}

// Signed distance to a spindle torus, major < minor. Its surface is the part of the circle beyond the axis, which
// ends in two tips on the axis.
inline long double spindle_distance(const Vec3& p, long double major, long double minor) {
  const Vec2 q = half_plane(p);
  const long double from_centre = std::hypot(q.x - major, q.y);
  if (from_centre >= minor) return from_centre - minor;
  const long double tip = std::sqrt(minor * minor - major * major);
  // The nearest point lies outwards from the circle's centre. If that point is beyond the axis, it is not on the
  // surface, and a tip is nearest.
  const bool faces = major + minor * (q.x - major) / from_centre >= 0;
  return faces ? from_centre - minor : -std::hypot(q.x, std::abs(q.y) - tip);
}

}  // namespace fathom::catalogue
