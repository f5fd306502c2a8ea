#include "runtime/chart/fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "vm/number/real.h"

namespace fathom::runtime {
namespace {

template <class Row>
auto key_of(const Row& row) {
  return std::tie(row.scene, row.method, row.precision, row.eps, row.sampler, row.lights);
}

}  // namespace

PowerLaw fit_power_law(std::span<const double> x, std::span<const double> y) {
  std::vector<double> logs_x, logs_y;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!(x[i] > 0 && y[i] > 0 && std::isfinite(x[i]) && std::isfinite(y[i]))) continue;
    logs_x.push_back(vm::real::log(x[i]));
    logs_y.push_back(vm::real::log(y[i]));
  }
  const auto mean = [](const std::vector<double>& numbers) {
    double sum = 0;
    for (const double number : numbers) sum += number;
    return sum / static_cast<double>(numbers.size());
  };
  const double mean_x = mean(logs_x), mean_y = mean(logs_y);
  double covariance = 0, variance = 0;
  for (std::size_t i = 0; i < logs_x.size(); ++i) {
    covariance += (logs_x[i] - mean_x) * (logs_y[i] - mean_y);
    variance += (logs_x[i] - mean_x) * (logs_x[i] - mean_x);
  }
  if (!(variance > 0)) return {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()};
  const double slope = covariance / variance;
  return {slope, vm::real::exp(mean_y - slope * mean_x)};
}

std::vector<ImageCurve> fit_curves(std::span<const ImageMeasurement> rows) {
  std::vector<ImageCurve> curves;
  for (const ImageMeasurement& row : rows) {
    const bool known = std::any_of(curves.begin(), curves.end(),
                                   [&](const ImageCurve& curve) { return key_of(curve) == key_of(row); });
    if (known) continue;
    std::vector<double> seconds, relmse;
    for (const ImageMeasurement& other : rows) {
      if (key_of(other) != key_of(row)) continue;
      seconds.push_back(other.seconds_med);
      relmse.push_back(other.relmse_med);
    }
    const PowerLaw law = fit_power_law(seconds, relmse);
    curves.push_back({row.scene, row.method, row.precision, row.eps, row.sampler, row.lights, law.slope, law.factor});
  }
  return curves;
}

double seconds_to(const ImageCurve& curve, double relmse) {
  if (!(curve.slope < 0)) return std::numeric_limits<double>::quiet_NaN();
  return vm::real::pow(relmse / curve.factor, 1 / curve.slope);
}

}  // namespace fathom::runtime
