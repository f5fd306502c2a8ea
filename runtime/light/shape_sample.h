// A point that was chosen on the surface of a lamp, for a place that the lamp lights, and its density.
// Tested by: tests/runtime/light/light_shapes_test.cpp
#pragma once

#include <glm/vec3.hpp>

namespace fathom::runtime {

struct ShapeSample {
  glm::dvec3 position{0};
  glm::dvec3 normal{0};  // outward
  double pdf = 0;        // per solid angle at the place it was chosen for; 0: no sample
};

}  // namespace fathom::runtime
