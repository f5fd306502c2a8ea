// Maps from the unit square to directions, each beside its density.
// Tested by: tests/runtime/warp_test.cpp
#pragma once

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "runtime/elementary.h"

namespace fathom::runtime {

// A direction of the upper hemisphere (z >= 0) with density cos/pi per solid angle.
// Malley's method: a uniform point of the disk, lifted onto the hemisphere (Pharr, Jakob, Humphreys, "Physically
// Based Rendering", 3rd ed. 2016, section 13.6.3).
inline glm::vec3 square_to_cosine_hemisphere(glm::vec2 u) {
  const float radius = std::sqrt(u.x);
  const SinCos angle = sincos_turn(u.y);
  return {radius * angle.cos, radius * angle.sin, std::sqrt(1 - u.x)};
}
inline float square_to_cosine_hemisphere_pdf(glm::vec3 w) { return w.z > 0 ? w.z * 0.318309886183790672f : 0.0f; }

// Axes of unit length about the unit vector z; all directions are unit vectors.
// Source: Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 2017, listing 3.
struct Frame {
  glm::vec3 x, y, z;

  explicit Frame(glm::vec3 n) : z(n) {
    const float sign = std::copysign(1.0f, n.z);
    const float a = -1 / (sign + n.z);
    const float b = n.x * n.y * a;
    x = glm::vec3(1 + sign * n.x * n.x * a, sign * b, -sign * n.x);
    y = glm::vec3(b, sign + n.y * n.y * a, -n.y);
  }
  glm::vec3 to_world(glm::vec3 local) const { return x * local.x + y * local.y + z * local.z; }
  glm::vec3 to_local(glm::vec3 world) const { return {glm::dot(world, x), glm::dot(world, y), glm::dot(world, z)}; }
};

// `local` in the frame whose z axis is n.
inline glm::vec3 to_frame(glm::vec3 n, glm::vec3 local) { return Frame(n).to_world(local); }

}  // namespace fathom::runtime
