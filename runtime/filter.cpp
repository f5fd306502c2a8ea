#include "runtime/filter.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "runtime/elementary.h"

namespace fathom::runtime {
namespace {

// Steps of the sums over half a support. A multiple of the quantiles' number, for the box filter to be exact.
constexpr int kSteps = 1 << 14;

double box(double) { return 1; }

double tent(double t) { return 1 - t; }

// Cut off at three standard deviations, and lowered to be 0 there.
double gaussian(double t) {
  return static_cast<double>(exp(static_cast<float>(-4.5 * t * t))) - static_cast<double>(exp(-4.5f));
}

// The minimum four-term window: Harris, "On the Use of Windows for Harmonic Analysis with the Discrete Fourier
// Transform", 1978, table I.
double blackman_harris(double t) {
  return 0.35875 + 0.48829 * sincos_turn(t / 2).cos + 0.14128 * sincos_turn(t).cos +
         0.01168 * sincos_turn(1.5 * t).cos;
}

// B = C = 1/3: Mitchell and Netravali, "Reconstruction Filters in Computer Graphics", 1988, equation 8.
double mitchell(double t) {
  const double x = 2 * t;
  return x < 1 ? (7 * x * x * x - 12 * x * x + 16.0 / 3) / 6 : ((-7.0 / 3 * x + 12) * x * x - 20 * x + 32.0 / 3) / 6;
}

struct Shape {
  double (*value)(double t);
  double width;  // of the support unless the scene says otherwise, pixels
};
// [FilterKind]
constexpr Shape kShapes[] = {{box, 1}, {tent, 2}, {gaussian, 3}, {blackman_harris, 3}, {mitchell, 4}};
static_assert(std::size(kShapes) == compiler::kFilterNames.size());

const Shape& shape_of(FilterKind kind) { return kShapes[static_cast<std::size_t>(kind)]; }

}  // namespace

double filter_value(FilterKind kind, double t) { return shape_of(kind).value(t); }

Filter::Filter(FilterKind kind, std::optional<double> width) : radius_(width.value_or(shape_of(kind).width) / 2) {
  const double step = radius_ / kSteps;
  std::vector<double> below(kSteps + 1, 0.0);  // [i] the magnitude nearer than i steps
  int positive = kSteps;                       // steps before the filter changes its sign
  for (int i = 0; i < kSteps; ++i) {
    const double value = filter_value(kind, (i + 0.5) / kSteps);
    if (value < 0) positive = std::min(positive, i);
    below[static_cast<std::size_t>(i) + 1] = below[static_cast<std::size_t>(i)] + std::abs(value);
  }
  std::size_t at = 0;
  for (int k = 0; k < kQuantiles; ++k) {
    const double share = below.back() * k / kQuantiles;
    while (below[at + 1] <= share) ++at;
    const double part = (share - below[at]) / (below[at + 1] - below[at]);
    quantiles_[static_cast<std::size_t>(k)] = static_cast<float>((static_cast<double>(at) + part) * step);
  }
  quantiles_[kQuantiles] = static_cast<float>(radius_);
  negative_from_ = positive == kSteps ? INFINITY : static_cast<float>(positive * step);
  // A positive coordinate is drawn so often; the weights' mean is 1.
  const double positive_share = below[static_cast<std::size_t>(positive)] / below.back();
  weight_ = static_cast<float>(1 / (2 * positive_share - 1));
}

// The |offset| below which that share of the magnitude lies.
float Filter::distance(float share) const {
  const float along = share * kQuantiles;
  const auto k = std::min(static_cast<std::size_t>(along), static_cast<std::size_t>(kQuantiles - 1));
  return quantiles_[k] + (along - static_cast<float>(k)) * (quantiles_[k + 1] - quantiles_[k]);
}

FilterSample Filter::sample(glm::vec2 u) const {
  FilterSample sample;
  for (int axis = 0; axis < 2; ++axis) {
    const float side = 2 * u[axis] - 1, away = distance(std::abs(side));
    sample.offset[axis] = std::copysign(away, side);
    sample.weight *= away >= negative_from_ ? -weight_ : weight_;
  }
  return sample;
}

}  // namespace fathom::runtime
