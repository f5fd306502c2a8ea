// An independent solver for benchmark scene H: the first place where a ray meets it, proved by interval arithmetic in
// double with the interval of the derivative along the ray. The scene is written here by hand, and nothing of vm/ or
// runtime/ is used: it judges them.
//
// A part of the ray is free of surface when the field's range over it, by its own formula or by the mean-value form,
// excludes zero, or when the field keeps rising or falling there and has one sign at both ends; it holds the first
// root when the sign changes and the field falls all the way. Everything else is cut in two, near half first.
// Source: Mitchell, "Robust Ray Intersection with Interval Arithmetic", 1990.
// Tested by: bench/bars_composite.cpp, where it and two other searches are compared ray by ray.
#pragma once

#include <glm/vec3.hpp>

namespace fathom::bench {

struct Line {
  glm::dvec3 origin, direction;  // scene units; of any length
};

struct Solution {
  // Undecided: a part of the ray shorter than kFinest of its length can neither be excluded nor holds a change of
  // sign.
  enum class Status { Hit, Miss, Undecided };
  Status status;
  double t = 0;  // of the hit, in units of |direction|; off by no more than the finest part
};

inline constexpr double kFinest = 1e-13;

// Within [0, t_max]. The ray starts outside or inside.
Solution solve_composite(const Line& line, double t_max);

// The scene's field at a point: scene units, positive outside.
double composite_distance(glm::dvec3 p);
// Its gradient, normalised; any of them where there are several.
glm::dvec3 composite_normal(glm::dvec3 p);

}  // namespace fathom::bench
