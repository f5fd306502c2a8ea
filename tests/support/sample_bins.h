// Whether samples fall as their density says: Pearson's chi-square statistic as standard deviations of a normal
// distribution, by Wilson and Hilferty, "The Distribution of Chi-Square", 1931. Bins in which fewer than 5 are
// expected are pooled; infinite when much falls where next to nothing is expected.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace fathom::test {

// `expected` are shares of all samples.
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
