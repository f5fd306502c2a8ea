// Tier 3 of marching: the first root along a ray by a certified search in double. It serves the few rays that float
// steps cannot decide (grazing, nearly touching, or simply long), and as the reference for everything else.
//
// A segment [a,b] with g(a), g(b) > 0 is free of surface if the value cannot come down to zero between its ends: if
// g(b) - g(a) and the bounds on the slope of g leave no room. With the field's Lipschitz constant L as the bound in
// both directions, the condition is |g(a)| + |g(b)| > L (b - a): two balls cover the segment (Hart, "Sphere Tracing",
// 1996). If the condition fails, interval arithmetic along the ray bounds value and slope over the segment (Mitchell,
// "Robust Ray Intersection with Interval Arithmetic", 1990). A value without zero, or a slope without a change of
// sign, decides the segment. Otherwise the search cuts the segment in two, keeps its bounds for both parts, and
// continues with the near part. The cut is in the middle or, where intervals are not informative, so near that two
// balls should just cover the near part.
// Tested by: tests/runtime/march/certify_test.cpp
#pragma once

#include <glm/vec3.hpp>

#include "runtime/field/field.h"
#include "runtime/march/certified_search.h"

namespace fathom::runtime {

// Returns the first root of g(t) = side * f(origin + t direction), where g(begin) is taken to be positive. If
// g(begin) is below 0, the result is a hit at `begin`. The search passes over no root, unless another root follows
// within 2^-30 max(1, |p|), which is then found instead. An exact 0 is a touch, and a root only if g goes on below 0.
// `side` 0 means the sign of f at `begin`. A NearMiss has no root, but comes nearer to one than the resolution of
// 2^-40 max(1, |p|), or of 2^-30 max(1, |p|) where the slope has no bound. The search always ends: after
// kSearchBudget evaluations its resolution becomes ever coarser, and segments that stay open make a NearMiss.
CertifiedResult certify(const Field& field, glm::dvec3 origin, glm::dvec3 direction, int side,
                        const RayInterval& interval, RealScratch& scratch);

}  // namespace fathom::runtime
