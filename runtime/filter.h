// How a pixel weighs the light around its centre, by choosing where samples go.
//
// Every sample is of one pixel: its place is drawn with the filter's magnitude as density, so that all samples of a
// filter without negative parts count alike. Ernst, Stamminger, Greiner, "Filter Importance Sampling", 2006.
//
//     const Filter filter(FilterKind::Gaussian);
//     const FilterSample place = filter.sample(u);    // offset from the pixel's centre; what the sample's light is
//                                                     // multiplied by
//
// Filters are products f(x) f(y). Tested by: tests/runtime/filter_test.cpp
#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <optional>

#include "compiler/compiled_scene.h"

namespace fathom::runtime {

using compiler::FilterKind;

struct FilterSample {
  glm::vec2 offset{0};  // from the pixel's centre, pixels; x right, y down
  float weight = 1;     // 1 on average; negative where the filter is
};

class Filter {
 public:
  // `width` of the support, pixels; without it the filter's own: box 1, tent 2, gaussian 3 (standard deviation 1/2),
  // blackman-harris 3, mitchell 4. The shape grows with the width.
  explicit Filter(FilterKind kind = FilterKind::Box, std::optional<double> width = std::nullopt);

  // u in [0,1)^2. Monotonous in each coordinate, so that what is stratified stays so.
  FilterSample sample(glm::vec2 u) const;

  double radius() const { return radius_; }  // half the support's width, pixels

 private:
  static constexpr int kQuantiles = 1024;

  float distance(float share) const;

  double radius_;
  // [k] |offset| below which k/kQuantiles of the filter's magnitude lies; between, the density is taken as constant.
  std::array<float, kQuantiles + 1> quantiles_;
  float negative_from_;  // |offset| from which on the filter is negative, pixels
  float weight_;         // of a positive coordinate: the filter's magnitude over its integral
};

// The filter at t radii from the centre, t in [0,1]; 1 is the end of the support.
double filter_value(FilterKind kind, double t);

}  // namespace fathom::runtime
