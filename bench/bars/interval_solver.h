// An independent solver for benchmark scene H: the first hit of a ray, proved by interval arithmetic in double with
// the interval of the derivative along the ray. The scene is written here by hand, and nothing of vm/ or runtime/ is
// used, because this solver judges them.
//
// The solver splits the ray into parts. A part has no surface when the field's range over the part, by the field's
// own formula or by the mean-value form, excludes zero, or when the field is monotone there and has the same sign at
// both ends. A part holds the first root when the sign changes and the field falls all the way. Every other part is
// cut in two, near half first. Source: Mitchell, "Robust Ray Intersection with Interval Arithmetic", 1990.
//
// Tested by: bench/bars/composite.cpp, which compares this and two other searches ray by ray.
#pragma once

#include <glm/vec3.hpp>

namespace fathom::bench {

struct Line {
  glm::dvec3 origin, direction;  // scene units; the direction has any length
};

struct Solution {
  // Undecided: in a part of the ray of relative length kFinest, the solver can neither exclude a surface nor find a
  // change of sign.
  enum class Status { Hit, Miss, Undecided };
  Status status;
  double t = 0;  // of the hit, in units of |direction|; off by no more than the finest part
};

inline constexpr double kFinest = 1e-13;

// Searches [0, t_max]. The ray starts outside or inside.
Solution solve_composite(const Line& line, double t_max);

// Returns the scene's field at a point, in scene units, positive outside.
double composite_distance(glm::dvec3 p);
// Returns the normalised gradient, or any one of them where several faces meet.
glm::dvec3 composite_normal(glm::dvec3 p);

}  // namespace fathom::bench
