// Tier 3 of marching: the first root along a ray by certified bisection in double, for the few rays that float steps
// cannot decide (grazing, nearly touching, or simply long).
//
// A segment [a,b] on which g keeps its sign at both ends is free of surface
//   - when |g(a)| + |g(b)| > L (b - a): the two unbounding balls cover it (Hart, "Sphere Tracing", 1996), or
//   - when interval arithmetic over its box excludes zero (Mitchell, "Robust Ray Intersection with Interval
//     Arithmetic", 1990).
// Otherwise it is cut in two, near half first, until a change of sign is bracketed (hit) or the segment is too short
// to matter (contact: treated as free, and reported). Tested by: tests/runtime/certify_test.cpp
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>

#include "runtime/field.h"
#include "vm/evaluate.h"

namespace fathom::runtime {

struct Certified {
  enum class Outcome { Hit, Miss, NotFinite, Exhausted };
  Outcome outcome;
  double t = 0;      // of the hit, in units of |direction|
  double width = 0;  // of the bracket that holds it
  std::uint32_t evaluations = 0;
  bool contact = false;  // a miss that came too near for the resolution to exclude a touch
};

// The first root of g(t) = side * f(origin + t direction) in [begin, end], where g(begin) is taken to be positive; a
// hit at `begin` when it is not. `end` must be finite. Exhausted only after a million evaluations (sixteen thousand
// when the Lipschitz constant is an estimate), which no certified field has been seen to need.
Certified certify(const Field& field, glm::dvec3 origin, glm::dvec3 direction, int side, double begin, double end,
                  vm::Workspace& workspace);

}  // namespace fathom::runtime
