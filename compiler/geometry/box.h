// Axis-aligned boxes, scene units. Sides may be infinite; lo > hi on any axis is the empty box.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <limits>

namespace fathom::compiler {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Box {
  glm::dvec3 lo{std::numeric_limits<double>::infinity()};
  glm::dvec3 hi{-std::numeric_limits<double>::infinity()};

  static Box everything() {
    const double inf = std::numeric_limits<double>::infinity();
    return {glm::dvec3(-inf), glm::dvec3(inf)};
  }
  static Box centred(glm::dvec3 half) { return {-half, half}; }

  bool empty() const { return lo.x > hi.x || lo.y > hi.y || lo.z > hi.z; }
  bool finite() const;
  bool contains(glm::dvec3 p) const {
    return p.x >= lo.x && p.x <= hi.x && p.y >= lo.y && p.y <= hi.y && p.z >= lo.z && p.z <= hi.z;
  }
  Box grown(double by) const { return empty() ? *this : Box{lo - by, hi + by}; }
  Box moved(glm::dvec3 by) const { return {lo + by, hi + by}; }
};

inline bool Box::finite() const {
  const double inf = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) {
    if (!(lo[i] > -inf && hi[i] < inf)) return false;
  }
  return true;
}
// Returns the largest magnitude of a coordinate.
inline double largest_part(glm::dvec3 v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }
inline Box unite(const Box& a, const Box& b) { return {glm::min(a.lo, b.lo), glm::max(a.hi, b.hi)}; }
inline Box intersect(const Box& a, const Box& b) { return {glm::max(a.lo, b.lo), glm::min(a.hi, b.hi)}; }

}  // namespace fathom::compiler
