// Measures for chart A: every method on every class of rays, timed side by side on one pinned thread and compared
// with the certified search in double. Tested by: tests/runtime/chart/chart_measure_test.cpp
#pragma once

#include <span>
#include <vector>

#include "runtime/chart/measurements.h"
#include "runtime/march/method.h"
#include "runtime/measure/ray_sets.h"

namespace fathom::runtime {

// Returns the methods of the chart, in float and double. Methods with a threshold have eps 1e-2 to 1e-6. The
// reference is last.
std::vector<Marching> charted_methods();

// Returns one row per method and set, all with `scene_name`. Times are medians over `rounds`, and a round runs each
// method once. A hit is gross when its error is more than a 250th of the extent. Rays that the reference calls
// near misses or invalid do not count.
std::vector<RayMeasurement> measure_rays(const compiler::CompiledScene& scene, const Field& field,
                                         std::span<const RaySet> sets, std::span<const Marching> methods, int rounds,
                                         const std::string& scene_name);

}  // namespace fathom::runtime
