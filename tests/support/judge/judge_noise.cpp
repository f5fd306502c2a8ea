#include "tests/support/judge/judge_noise.h"

#include <cmath>
#include <glm/geometric.hpp>

namespace fathom::test {
namespace {

long noise_permuted(long n) {
  const long m = (n % 289 + 289) % 289;
  return (34 * m + 10) * m % 289;
}

double quintic(double t) { return 6 * std::pow(t, 5) - 15 * std::pow(t, 4) + 10 * std::pow(t, 3); }

}  // namespace

glm::dvec3 judge_noise_direction(long x, long y, long z) {
  const long hash = noise_permuted(noise_permuted(noise_permuted(x) + y) + z);
  const long centred = hash > 144 ? hash - 289 : hash;
  const bool minus_first = (centred & 3) < 2, minus_second = (centred & 3) == 1 || (centred & 3) == 2;
  const double first = minus_first ? -1 : 1, second = minus_second ? -1 : 1;
  if (centred <= -48) return {first, second, 0};
  return centred <= 48 ? glm::dvec3(first, 0, second) : glm::dvec3(0, first, second);
}

double judge_noise(glm::dvec3 p) {
  const glm::dvec3 cell = glm::floor(p);
  double sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 at = cell + glm::dvec3(corner & 1, corner >> 1 & 1, corner >> 2);
    double weight = 1;
    for (int axis = 0; axis < 3; ++axis) weight *= quintic(1 - std::abs(p[axis] - at[axis]));
    const glm::dvec3 direction = judge_noise_direction(std::lround(at.x), std::lround(at.y), std::lround(at.z));
    sum += weight * glm::dot(direction, p - at);
  }
  return sum;
}

}  // namespace fathom::test
