// Chart A, rays: what a ray costs against how far off its hit is, a panel for each class of rays.
//
// A polyline is a method in one precision, its points the tolerances eps; variants by relaxation or by a limit of
// steps are polylines of their own. f32 has solid markers, f64 hollow ones. The staircase is reliable_front() and
// rings mark on_pareto_front() (runtime/chart/pareto.h): where the default is on the front, it is on the staircase.
// Tested by: tests/runtime/chart/chart_charts_test.cpp
#pragma once

#include <span>
#include <string>

#include "runtime/chart/measurements.h"
#include "runtime/chart/pareto.h"

namespace fathom::runtime {

// The rows of `scene` as SVG; camera, bounce and grazing first, in this order, other classes as they come.
std::string chart_a(std::span<const RayMeasurement> rows, const std::string& scene, Cost cost,
                    const Provenance& provenance);

// How a row is called in charts and tables: "sphere tracing f32", with relaxation and steps only where the rows have
// the method in several.
std::string name_of(const RayMeasurement& row, std::span<const RayMeasurement> rows);

}  // namespace fathom::runtime
