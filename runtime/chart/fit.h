// Power laws through measured points: least squares of log y on log x.
// Tested by: tests/runtime/chart/chart_pareto_test.cpp
#pragma once

#include <span>
#include <vector>

#include "runtime/chart/measurements.h"

namespace fathom::runtime {

// y = factor * x^slope. Both are NaN where there are no two different x.
struct PowerLaw {
  double slope, factor;
};

// Points that have no logarithm (0, negative, not finite) take no part. The spans are equally long.
PowerLaw fit_power_law(std::span<const double> x, std::span<const double> y);

// relMSE over seconds for each scene, method, precision, eps, sampler and way to lights, in the order in which they
// come first.
std::vector<ImageCurve> fit_curves(std::span<const ImageMeasurement> rows);

// When a picture's error falls to relMSE if the law goes on; NaN where it does not fall.
double seconds_to(const ImageCurve& curve, double relmse);

}  // namespace fathom::runtime
