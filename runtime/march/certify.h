// Tier 3 of marching: the first root along a ray by certified search in double, for the few rays that float steps
// cannot decide (grazing, nearly touching, or simply long), and the reference that everything else is compared with.
//
// A segment [a,b] with g(a), g(b) > 0 is free of surface when the value cannot come down to zero between them: when
// (g(b) - g(a)) and the bounds on g's slope leave no room. With the field's constant L as that bound on either side
// this is |g(a)| + |g(b)| > L (b - a), two balls that cover the segment (Hart, "Sphere Tracing", 1996). Where it
// takes more, interval arithmetic along the ray bounds value and slope over the segment (Mitchell, "Robust Ray
// Intersection with Interval Arithmetic", 1990): a value without zero, or a slope without change of sign, settles it,
// and what remains is cut in two with the bounds it has, near part first: in the middle, or where intervals tell
// nothing so near that two balls should just cover the way. Tested by: tests/runtime/march/certify_test.cpp
#pragma once

#include <glm/vec3.hpp>

#include "runtime/field/field.h"
#include "runtime/march/search.h"

namespace fathom::runtime {

// The first root of g(t) = side * f(origin + t direction), where g(begin) is taken to be positive; a hit at `begin`
// when it is below 0. No root is passed, except where another follows within 2^-30 max(1, |p|), which is then found
// in its place. An exact 0 is a touch: a root only when g goes on below it. `side` 0: the sign of f at `begin`.
// Contact: no root, but nearer to one than the resolution of 2^-40 max(1, |p|). Always ends: a search that takes more
// than kSearchBudget evaluations goes on at ever coarser resolution, and what stays open is a contact.
Certified certify(const Field& field, glm::dvec3 origin, glm::dvec3 direction, int side, const Stretch& stretch,
                  RealScratch& scratch);

}  // namespace fathom::runtime
