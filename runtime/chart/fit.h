// Power laws fitted to measured points: least squares of log y on log x.
// Tested by: tests/runtime/chart/chart_pareto_test.cpp
#pragma once

#include <span>
#include <vector>

#include "runtime/chart/measurements.h"

namespace fathom::runtime {

// y = factor * x^slope. Both are NaN if fewer than two different x have a logarithm.
struct PowerLaw {
  double slope, factor;
};

// Ignores points without a logarithm (a coordinate that is 0, negative or not finite). The spans have equal length.
PowerLaw fit_power_law(std::span<const double> x, std::span<const double> y);

// Fits relMSE over seconds for each scene, method, precision, eps, sampler and light sampling, in order of first
// appearance.
std::vector<ImageCurve> fit_curves(std::span<const ImageMeasurement> rows);

// Seconds after which the fitted law reaches `relmse`. NaN unless the error falls with time.
double seconds_to(const ImageCurve& curve, double relmse);

}  // namespace fathom::runtime
