// Chart B, images: render time against the error of the image, relMSE to the reference.
//
// A polyline is one method in one precision with one eps, and its points are the numbers of samples per pixel. The
// second panel excludes the worst 0.1 % of the pixels. A slope in a curve's name is a fit to all its points. A dashed
// line is a curve's floor, its bias: more samples do not reduce the error any further. With k seeds, a floor below
// 1/k of the curve's last point is not measurable. The chart draws the floor at the highest number of samples.
// Tested by: tests/runtime/chart/chart_charts_test.cpp
#pragma once

#include <span>
#include <string>

#include "runtime/chart/measurements.h"

namespace fathom::runtime {

// Returns the chart of the rows of `scene` as SVG, only rows with the default sampler and light sampling.
std::string chart_b(std::span<const ImageMeasurement> rows, const std::string& scene, const Provenance& provenance);

// Returns the chart of rows with the default method. A curve is one sampler with one kind of light sampling, and its
// name gives the time to a relMSE of 1e-3 by the fitted power law.
std::string chart_light(std::span<const ImageMeasurement> rows, const std::string& scene,
                        const Provenance& provenance);

}  // namespace fathom::runtime
