// Gradient noise from its definition: the corners' hashes in integer arithmetic, the gradients as a list, the mean of
// the eight planes by the product of the axes' weights. Source: Perlin, "Improving Noise", 2002.
#pragma once

#include <glm/vec3.hpp>

namespace fathom::test {

// Gradient at an integer point of the lattice.
glm::dvec3 judge_noise_direction(long x, long y, long z);
// Noise at p. Coordinates must be below 2^22.
double judge_noise(glm::dvec3 p);

}  // namespace fathom::test
