// A point sampled on the surface of an area light for a shading point, and its density.
// Tested by: tests/runtime/light/light_shapes_test.cpp
#pragma once

#include <glm/vec3.hpp>

namespace fathom::runtime {

struct ShapeSample {
  glm::dvec3 position{0};
  glm::dvec3 normal{0};  // outward
  double pdf = 0;        // per solid angle at the shading point; 0: no sample
};

}  // namespace fathom::runtime
