#include "runtime/sampling/filter.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>

#include "runtime/base/elementary.h"
#include "vm/number/real.h"

namespace fathom::runtime {
namespace {

double box(double) { return 1; }

double tent(double t) { return 1 - t; }

// Truncated at three standard deviations, and lowered to be 0 there.
double gaussian(double t) {
  return static_cast<double>(exp(static_cast<float>(-4.5 * t * t))) - static_cast<double>(exp(-4.5f));
}

// The minimum four-term window: Harris, "On the Use of Windows for Harmonic Analysis with the Discrete Fourier
// Transform", 1978, table I.
double blackman_harris(double t) {
  const auto cosine = [](double turns) { return vm::real::sin_cos_turns(turns).cos; };
  return 0.35875 + 0.48829 * cosine(t / 2) + 0.14128 * cosine(t) + 0.01168 * cosine(1.5 * t);
}

// B = C = 1/3: Mitchell and Netravali, "Reconstruction Filters in Computer Graphics", 1988, equation 8.
double mitchell(double t) {
  const double x = 2 * t;
  return x < 1 ? (7 * x * x * x - 12 * x * x + 16.0 / 3) / 6 : ((-7.0 / 3 * x + 12) * x * x - 20 * x + 32.0 / 3) / 6;
}

struct Shape {
  double (*value)(double t);
  double width;  // of the support unless the scene gives another, pixels
};
// [FilterKind]
constexpr Shape kShapes[] = {{box, 1}, {tent, 2}, {gaussian, 3}, {blackman_harris, 3}, {mitchell, 4}};
static_assert(std::size(kShapes) == compiler::kFilterNames.size());

const Shape& shape_of(FilterKind kind) { return kShapes[static_cast<std::size_t>(kind)]; }

}  // namespace

double filter_value(FilterKind kind, double t) { return shape_of(kind).value(t); }

Filter::Filter(FilterKind kind, std::optional<double> width)
    : kind_(kind), radius_(width.value_or(shape_of(kind).width) / 2) {
  std::size_t positive = kCells;  // number of cells before the filter changes its sign
  for (std::size_t i = 0; i <= kCells; ++i) {
    const double value = filter_value(kind, static_cast<double>(i) / kCells);
    if (value < 0) positive = std::min(positive, i);
    magnitude_[i] = std::abs(value);
    cdf_[i] = i == 0 ? 0 : cdf_[i - 1] + (magnitude_[i - 1] + magnitude_[i]) / 2;
  }
  const double all = cdf_[kCells];
  for (double& share : cdf_) share /= all;
  std::size_t cell = 0;
  for (std::size_t k = 0; k < kCells; ++k) {
    while (cdf_[cell + 1] <= static_cast<double>(k) / kCells) ++cell;
    cdf_guide_[k] = static_cast<std::uint16_t>(cell);
  }
  negative_from_ = positive == kCells ? INFINITY : radius_ * static_cast<double>(positive) / kCells;
  // A coordinate is positive with probability cdf_[positive], else negative. The weights' mean is 1.
  weight_ = static_cast<float>(1 / (2 * cdf_[positive] - 1));
}

// Returns the |offset| below which the share of the magnitude lies, share in [0,1). The density is linear in a
// cell, so the offset is the root of a quadratic.
double Filter::invert_cdf(double share) const {
  std::size_t cell = cdf_guide_[static_cast<std::size_t>(share * kCells)];
  while (cdf_[cell + 1] <= share) ++cell;
  const double t = (share - cdf_[cell]) / (cdf_[cell + 1] - cdf_[cell]);
  if (!(t > 0)) return radius_ * static_cast<double>(cell) / kCells;
  const double p = magnitude_[cell], q = magnitude_[cell + 1];
  const double part = t * (p + q) / (p + std::sqrt(p * p + t * (q * q - p * p)));
  return radius_ * (static_cast<double>(cell) + part) / kCells;
}

FilterSample Filter::sample_density(glm::vec2 u) const {
  FilterSample sample;
  for (int axis = 0; axis < 2; ++axis) {
    const double side = 2 * static_cast<double>(u[axis]) - 1;
    // u = 0 has the share 1, which lies at the support's end.
    const double away = side == -1 ? radius_ : invert_cdf(std::abs(side));
    sample.offset[axis] = static_cast<float>(std::copysign(away, side));
    sample.weight *= away >= negative_from_ ? -weight_ : weight_;
  }
  return sample;
}

}  // namespace fathom::runtime
