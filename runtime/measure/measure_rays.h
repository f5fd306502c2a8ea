// The measuring half of chart A: every method on every class of rays, timed side by side on one pinned thread and
// compared with the certified search in double. Tested by: tests/runtime/chart/chart_measure_test.cpp
#pragma once

#include <span>
#include <vector>

#include "runtime/chart/measurements.h"
#include "runtime/march/method.h"
#include "runtime/measure/ray_sets.h"

namespace fathom::runtime {

// What is charted: each method, those with a threshold at eps 1e-2 to 1e-6, in float and double; the reference last.
std::vector<Marching> charted_methods();

// One row for each method and set, `scene_name` in all. Times are medians over `rounds`, each method once a round. A
// hit is gross when it is off by more than a 250th of the extent. Rays that the reference calls contacts or invalid
// count for nobody.
std::vector<RayMeasurement> measure_rays(const compiler::CompiledScene& scene, const Field& field,
                                         std::span<const RaySet> sets, std::span<const Marching> methods, int rounds,
                                         const std::string& scene_name);

}  // namespace fathom::runtime
