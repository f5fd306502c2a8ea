// A place that is to be lit, and how much light of a colour counts.
#pragma once

#include <glm/vec3.hpp>

namespace fathom::runtime {

struct LightQuery {
  glm::dvec3 position;      // programs' coordinates
  glm::vec3 normal;         // of the surface there, unit
  bool both_sides = false;  // light from behind the surface counts, too
};

// The Y of CIE XYZ. Source: IEC 61966-2-1:1999.
inline float luminance(glm::vec3 c) { return 0.2126f * c.x + 0.7152f * c.y + 0.0722f * c.z; }

}  // namespace fathom::runtime
