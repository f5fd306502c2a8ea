// Reconstruction filters, sampled: the filter decides where in the pixel's neighbourhood a sample goes.
//
// Every sample belongs to one pixel. Its place is drawn with the filter's magnitude as density, so all samples of
// a filter without negative parts have the same weight. Ernst, Stamminger, Greiner, "Filter Importance Sampling",
// 2006.
//
//     const Filter filter(FilterKind::Gaussian);
//     const FilterSample place = filter.sample(u);    // offset from the pixel's centre, and factor of the radiance
//
// Filters are products f(x) f(y). Tested by: tests/runtime/sampling/filter_test.cpp
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <optional>

#include "compiler/scene/compiled_scene.h"

namespace fathom::runtime {

using compiler::FilterKind;

struct FilterSample {
  glm::vec2 offset{0};  // from the pixel's centre, pixels; x right, y down
  float weight = 1;     // factor of the sample's radiance: 1 on average; negative where the filter is
};

class Filter {
 public:
  // `width`: of the support, pixels. By default the filter's own: box 1, tent 2, gaussian 3 (standard deviation 1/2),
  // blackman-harris 3, mitchell 4. The shape grows with the width.
  explicit Filter(FilterKind kind = FilterKind::Box, std::optional<double> width = std::nullopt);

  // u in [0,1)^2. Monotonic in each coordinate, so that stratified u give stratified offsets.
  FilterSample sample(glm::vec2 u) const {
    // Shortcut for a constant: the same as below, at a fraction of its time.
    if (kind_ == FilterKind::Box) return {(u - 0.5f) * static_cast<float>(2 * radius_), 1};
    return sample_density(u);
  }

  double radius() const { return radius_; }  // half the support's width, pixels

 private:
  static constexpr int kCells = 1024;  // of equal width from the centre to the support's end

  FilterSample sample_density(glm::vec2 u) const;
  double invert_cdf(double share) const;

  FilterKind kind_;
  double radius_;
  std::array<double, kCells + 1> magnitude_;  // at the cells' ends; linear between
  std::array<double, kCells + 1> cdf_;        // [i] share of the magnitude before cell i
  std::array<std::uint16_t, kCells> cdf_guide_;  // [k] cell in which the share k/kCells is reached
  double negative_from_ = 0;                  // |offset| from which on the filter is negative, pixels
  float weight_ = 1;                          // of a positive coordinate: the magnitude's integral over the filter's
};

// Returns the filter's value at t radii from the centre, t in [0,1]; 1 is the end of the support.
double filter_value(FilterKind kind, double t);

}  // namespace fathom::runtime
