// Helpers for the shapes of area lights: choosing a part of the surface, and converting densities over area to
// densities over directions. Tested by: tests/runtime/light/light_shapes_test.cpp
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "runtime/light/shape_sample.h"

namespace fathom::runtime {

inline double sqr(double x) { return x * x; }

// A distribution over the parts of a shape. sample() picks a part by a number, and makes the number uniform again.
template <std::size_t N>
struct DiscreteDistribution {
  std::array<double, N> weights{};

  double sum() const {
    double total = 0;
    for (const double w : weights) total += w;
    return total;
  }
  double pmf(std::size_t part) const { return weights[part] / sum(); }
  // Requires sum() > 0.
  std::size_t sample(double& u) const {
    double rest = u * sum();
    std::size_t part = 0, last = 0;
    for (std::size_t i = 0; i < N; ++i) {
      if (weights[i] > 0) last = i;
    }
    while (part < last && !(rest < weights[part])) rest -= weights[part++];
    u = std::clamp(rest / weights[part], 0.0, 1.0);
    return part;
  }
};

// Returns the density per solid angle of a point sampled uniformly over an area.
inline double area_to_solid_angle(const ShapeSample& at, glm::dvec3 from, double area) {
  const glm::dvec3 way = from - at.position;
  const double d2 = glm::dot(way, way), facing = glm::dot(at.normal, way);
  return facing > 0 ? d2 * std::sqrt(d2) / (facing * area) : 0;
}

}  // namespace fathom::runtime
