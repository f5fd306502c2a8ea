// Gradient noise from its definition: the corners' hashes in whole numbers, the directions as a list, the mean of the
// eight planes by the product of the axes' weights. Source: Perlin, "Improving Noise", 2002.
#pragma once

#include <glm/vec3.hpp>

namespace fathom::test {

// The direction at a whole point of the lattice.
glm::dvec3 judge_noise_direction(long x, long y, long z);
// At coordinates below 2^22.
double judge_noise(glm::dvec3 p);

}  // namespace fathom::test
