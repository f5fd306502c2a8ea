// Chart A, rays: cost per ray against the error of the hit distance, one panel per ray class.
//
// A polyline is one method in one precision, and its points are the tolerances eps. Variants by relaxation or step
// limit are polylines of their own. Markers are solid for f32 and hollow for f64. The staircase is reliable_front()
// and rings mark on_pareto_front() (runtime/chart/pareto.h): if the default is on the front, it is also on the
// staircase.
// Tested by: tests/runtime/chart/chart_charts_test.cpp
#pragma once

#include <span>
#include <string>

#include "runtime/chart/measurements.h"
#include "runtime/chart/pareto.h"

namespace fathom::runtime {

// Returns the chart of the rows of `scene` as SVG. The panels are camera, bounce and grazing rays in this order, then
// other ray classes in order of first appearance.
std::string chart_a(std::span<const RayMeasurement> rows, const std::string& scene, Cost cost,
                    const Provenance& provenance);

// Returns the row's name in charts and tables, for instance "sphere tracing f32". The name has relaxation and step
// limit only where they vary among the method's rows.
std::string name_of(const RayMeasurement& row, std::span<const RayMeasurement> rows);

}  // namespace fathom::runtime
