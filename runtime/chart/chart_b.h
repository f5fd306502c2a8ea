// Chart B, pictures: how long a picture takes against how far it is from the reference, relMSE.
//
// A polyline is a method in one precision with one eps, its points the numbers of samples per pixel; the second panel
// is without the worst 0.1 % of the pixels. Where a curve's slope is given, it is fitted to all its points. A dashed
// line is a curve's floor, its bias: more samples lead no further down. Of k seeds a floor below 1/k of the curve's
// last point cannot be seen; what is drawn is the floor at the most samples. Tested by:
// tests/runtime/chart/chart_charts_test.cpp
#pragma once

#include <span>
#include <string>

#include "runtime/chart/measurements.h"

namespace fathom::runtime {

// The rows of `scene` as SVG: those with the default's sampler and way to find light.
std::string chart_b(std::span<const ImageMeasurement> rows, const std::string& scene, const Provenance& provenance);

// Those with the default's method: a curve is a sampler and a way to find light, and its name says the time to a
// relMSE of 1e-3 by the fitted law.
std::string chart_light(std::span<const ImageMeasurement> rows, const std::string& scene,
                        const Provenance& provenance);

}  // namespace fathom::runtime
