// A piecewise-constant density over directions. Cells have equal longitude and polar angle, like the pixels of a
// latitude-longitude image. Within a cell directions are uniform per solid angle.
//
// Source: Pharr, Jakob, Humphreys, "Physically Based Rendering", 3rd ed. 2016, sections 13.6.7 and 14.2.4, with the
// cells' solid angles instead of the sine at their middles. Tested by:
// tests/runtime/sampling/piecewise_constant_sphere_test.cpp
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace fathom::runtime {

// Map a direction to u and v in [0,1], and back. v runs from +y down to -y with the polar angle. u is the turn about
// y, 1/2 at -z and growing towards +x.
glm::dvec2 to_latlong(glm::dvec3 direction);
glm::dvec3 from_latlong(glm::dvec2 uv);

class PiecewiseConstantSphere {
 public:
  PiecewiseConstantSphere() = default;
  // Takes densities in any unit, finite and not negative: `height` rows of `width` cells, from +y down.
  PiecewiseConstantSphere(int width, int height, std::span<const float> values);

  // Returns the mean of the values over the sphere; 0 when there is nothing to sample.
  double mean() const { return mean_; }
  glm::vec3 sample(glm::vec2 u) const;   // needs mean() > 0
  float pdf(glm::vec3 direction) const;  // per solid angle

 private:
  double solid_angle(std::size_t row) const;  // of one cell of the row

  std::size_t width_ = 0, height_ = 0;
  double mean_ = 0;
  std::vector<double> heights_;  // y of the rows' borders, height_ + 1
  std::vector<double> rows_;     // running sums of the rows' probabilities
  std::vector<float> columns_;   // the same within each row
};

}  // namespace fathom::runtime
