// A shading point, for which light is sampled.
#pragma once

#include <glm/vec3.hpp>

namespace fathom::runtime {

struct LightSampleContext {
  glm::dvec3 position;      // in the programs' coordinates
  glm::vec3 normal;         // of the surface there, unit
  bool both_sides = false;  // light from behind the surface counts, too
};

}  // namespace fathom::runtime
