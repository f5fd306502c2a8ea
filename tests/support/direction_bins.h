// Whether directions fall as their density says: a chi-square test over bins of the sphere of equal solid angle.
//
// The density is integrated over each bin by a grid of midpoints, so it must not jump finely within bins; what a
// sampler rejects is a bin of its own. Bins in which fewer than 5 are expected are pooled.
// Source: Pearson 1900; quantile of chi-square by Wilson and Hilferty, "The Distribution of Chi-Square", 1931.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

namespace fathom::test {

class DirectionBins {
 public:
  // Bins around `axis` within the cone of the cosine `least` (-1: the whole sphere), so that a small light is cut
  // into many. What falls outside is a bin of its own.
  DirectionBins(glm::dvec3 axis, double least, int rows = 16, int columns = 32)
      : axis_(axis), least_(least), rows_(rows), columns_(columns), counts_(bins() + 1), expected_(bins() + 1) {
    glm::dvec3 other(0);
    other[std::abs(axis.x) < 0.6 ? 0 : 1] = 1;
    side_ = glm::normalize(glm::cross(axis, other));
    up_ = glm::cross(axis, side_);
  }

  void add(std::optional<glm::dvec3> w) {
    ++total_;
    ++counts_[w ? bin(*w) : bins()];
  }

  // The density's share in each bin; the rest is expected outside. Returns the integral over the bins.
  double integrate(const std::function<double(glm::dvec3)>& pdf, int grid = 24) {
    const double cell = (1 - least_) * 2 * M_PI / (rows_ * columns_ * grid * grid);
    double all = 0;
    for (int r = 0; r < rows_ * grid; ++r) {
      for (int c = 0; c < columns_ * grid; ++c) {
        const double z = 1 - (1 - least_) * (r + 0.5) / (rows_ * grid), s = std::sqrt(1 - z * z);
        const double turn = 2 * M_PI * (c + 0.5) / (columns_ * grid);
        const double mass = pdf(z * axis_ + s * (std::cos(turn) * side_ + std::sin(turn) * up_)) * cell;
        expected_[static_cast<std::size_t>(r / grid * columns_ + c / grid)] += mass;
        all += mass;
      }
    }
    expected_.back() = std::max(0.0, 1 - all);
    return all;
  }

  // How many standard deviations of a normal distribution the statistic is above its mean.
  double deviation() const {
    double statistic = 0, pooled = 0, pooled_count = 0;
    int degrees = -1;
    const auto term = [&](double count, double expected) {
      statistic += (count - expected) * (count - expected) / expected;
      ++degrees;
    };
    for (std::size_t i = 0; i < counts_.size(); ++i) {
      const double expected = expected_[i] * total_;
      if (expected >= 5) {
        term(counts_[i], expected);
      } else {
        pooled += expected;
        pooled_count += counts_[i];
      }
    }
    if (pooled >= 5) term(pooled_count, pooled);
    if (pooled < 5 && pooled_count > 30) return INFINITY;  // where next to nothing is expected
    const double n = std::max(1, degrees);
    return (std::cbrt(statistic / n) - (1 - 2 / (9 * n))) / std::sqrt(2 / (9 * n));
  }

 private:
  std::size_t bins() const { return static_cast<std::size_t>(rows_ * columns_); }
  std::size_t bin(glm::dvec3 w) const {
    const double z = glm::dot(w, axis_);
    if (z < least_) return bins();
    const int r = std::min(rows_ - 1, static_cast<int>((1 - z) / (1 - least_) * rows_));
    const double turn = std::atan2(glm::dot(w, up_), glm::dot(w, side_)) / (2 * M_PI);
    const int c = std::min(columns_ - 1, static_cast<int>((turn < 0 ? turn + 1 : turn) * columns_));
    return static_cast<std::size_t>(r * columns_ + c);
  }

  glm::dvec3 axis_, side_, up_;
  double least_;
  int rows_, columns_;
  double total_ = 0;
  std::vector<double> counts_, expected_;
};

}  // namespace fathom::test
