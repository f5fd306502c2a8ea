// Directions from vectors of any length.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace fathom::compiler {

// Returns the unit vector along `v`, which is not 0. Divides by the largest component first, so that the square of
// 1e-200 does not vanish and the square of 1e200 does not overflow.
inline glm::dvec3 direction(glm::dvec3 v) {
  return glm::normalize(v / std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}));
}

}  // namespace fathom::compiler
