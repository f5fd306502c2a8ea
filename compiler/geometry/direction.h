// Directions from vectors of any length.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace fathom::compiler {

// The unit vector along `v`, which is not 0. Divided by the largest part first, so that no square of 1e-200 vanishes
// and none of 1e200 overflows.
inline glm::dvec3 direction(glm::dvec3 v) {
  return glm::normalize(v / std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}));
}

}  // namespace fathom::compiler
