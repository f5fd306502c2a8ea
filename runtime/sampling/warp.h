// Maps from the unit square to directions, with their densities.
// Tested by: tests/runtime/sampling/warp_test.cpp
#pragma once

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "runtime/base/elementary.h"

namespace fathom::runtime {

// Returns a direction of the upper hemisphere (z >= 0) with density cos/pi per solid angle.
// Malley's method: a uniform point of the disk, lifted onto the hemisphere (Pharr, Jakob, Humphreys, "Physically
// Based Rendering", 3rd ed. 2016, section 13.6.3).
inline glm::vec3 square_to_cosine_hemisphere(glm::vec2 u) {
  const float radius = std::sqrt(u.x);
  const SinCos angle = sincos_turn(u.y);
  return {radius * angle.cos, radius * angle.sin, std::sqrt(1 - u.x)};
}
inline float square_to_cosine_hemisphere_pdf(glm::vec3 w) { return w.z > 0 ? w.z * 0.318309886183790672f : 0.0f; }

// Orthonormal axes around the unit vector z. All directions are unit vectors.
// Source: Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 2017, listing 3.
template <class T>
struct FrameOf {
  using Vec = glm::vec<3, T>;
  Vec x, y, z;

  explicit FrameOf(Vec n) : z(n) {
    const T sign = std::copysign(T{1}, n.z);
    const T a = -1 / (sign + n.z);
    const T b = n.x * n.y * a;
    x = Vec(1 + sign * n.x * n.x * a, sign * b, -sign * n.x);
    y = Vec(b, sign + n.y * n.y * a, -n.y);
  }
  Vec to_world(Vec local) const { return x * local.x + y * local.y + z * local.z; }
  Vec to_local(Vec world) const { return {glm::dot(world, x), glm::dot(world, y), glm::dot(world, z)}; }
};
using Frame = FrameOf<float>;

// Returns `local`, given in the frame with the z axis n, in world coordinates.
inline glm::vec3 to_frame(glm::vec3 n, glm::vec3 local) { return Frame(n).to_world(local); }

}  // namespace fathom::runtime
