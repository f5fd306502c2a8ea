// Points and boxes in the plane of outlines.
#pragma once

#include <cmath>
#include <cstddef>
#include <glm/vec2.hpp>
#include <initializer_list>

#include "compiler/shapes/node_spec.h"
#include "vm/number/real.h"

namespace fathom::compiler {

inline glm::dvec2 vec2_at(Params p, std::size_t i) { return {p[i], p[i + 1]}; }
inline double cross(glm::dvec2 a, glm::dvec2 b) { return a.x * b.y - a.y * b.x; }

// Returns the point at a distance from the origin, at an angle in degrees from +y towards +x.
inline glm::dvec2 at_polar(double radius, double degrees) {
  const vm::real::SinCos at = vm::real::sin_cos_degrees(degrees);
  return {radius * at.sin, radius * at.cos};
}

// Outlines are infinite along z.
inline Box planar_box(glm::dvec2 lo, glm::dvec2 hi) { return {{lo.x, lo.y, -kInfinity}, {hi.x, hi.y, kInfinity}}; }

// Returns the box of points and their mirror images across x = 0.
inline Box mirrored_hull(std::initializer_list<glm::dvec2> points) {
  Box box;
  for (glm::dvec2 q : points) {
    q.x = std::abs(q.x);
    box = unite(box, planar_box({-q.x, q.y}, q));
  }
  return box;
}

// Returns the box of an outline whose first parameters are its half extents: one for x and y, or one for each.
inline Box square_bound(Params p) { return planar_box(glm::dvec2(-p[0]), glm::dvec2(p[0])); }
inline Box half_sizes_bound(Params p) { return planar_box(-vec2_at(p, 0), vec2_at(p, 0)); }

}  // namespace fathom::compiler
