// Steps of points that lie evenly in the unit cube, however many of them are taken: the n-th point is
// glm::fract(n * kEvenSteps). The steps are powers of the root of g^4 = g + 1, inverted. Source: Roberts, "The
// Unreasonable Effectiveness of Quasirandom Sequences", 2018.
#pragma once

#include <glm/vec3.hpp>

namespace fathom::runtime {

inline constexpr glm::dvec3 kEvenSteps(0.8191725133961645, 0.6710436067037893, 0.5497004779019703);

}  // namespace fathom::runtime
