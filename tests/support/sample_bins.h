// Chi-square goodness-of-fit test of samples against their density. Returns Pearson's statistic as standard
// deviations of a normal distribution. Source: Wilson and Hilferty, "The Distribution of Chi-Square", 1931. Bins that
// expect fewer than 5 samples are pooled. The result is infinite when many samples fall where almost none are
// expected.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace fathom::test {

// `expected`: fraction of all samples per bin. `n`: number of samples.
inline double chi_square_deviation(const std::vector<double>& counts, const std::vector<double>& expected, int n) {
  double statistic = 0, pooled = 0, pooled_count = 0;
  int degrees = -1;
  const auto term = [&](double count, double mean) {
    statistic += (count - mean) * (count - mean) / mean;
    ++degrees;
  };
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const double mean = expected[i] * n;
    if (mean >= 5) {
      term(counts[i], mean);
    } else {
      pooled += mean;
      pooled_count += counts[i];
    }
  }
  if (pooled >= 5) term(pooled_count, pooled);
  if (pooled < 5 && pooled_count > 30) return INFINITY;
  const double k = std::max(1, degrees);
  return (std::cbrt(statistic / k) - (1 - 2 / (9 * k))) / std::sqrt(2 / (9 * k));
}

}  // namespace fathom::test
