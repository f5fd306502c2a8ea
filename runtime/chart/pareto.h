// Which measurements are worth choosing: no other is at once no slower, no less accurate and no more often wrong.
//
// Only rows of the same scene and class of rays are compared. One row dominates another when its cost, its 99th
// percentile of |t - t_ref| and its failures are no greater and one of the three is less. The reference takes no
// part: its error is 0 by definition, not by measurement. A row with a number that was not measured takes no part
// either. Tested by: tests/runtime/chart/chart_pareto_test.cpp
#pragma once

#include <span>
#include <string>
#include <vector>

#include "runtime/chart/measurements.h"

namespace fathom::runtime {

enum class Cost { Time, Evaluations };  // nanoseconds per ray, mean evaluations per ray
double cost_of(const RayMeasurement& row, Cost cost);

// False hits, false misses, rays out of steps and gross errors; contacts are none.
double failures_ppm(const RayMeasurement& row);

// The most failures that 0 of `rays` do not rule out with 95 % confidence, ppm: the rule of three (J. Hanley,
// A. Lippman-Hand, "If Nothing Goes Wrong, Is Everything All Right?", 1983).
double unseen_failures_ppm(std::uint64_t rays);

// What Fathom does when nothing else is asked.
bool is_default(const RayMeasurement& row);

bool dominates(const RayMeasurement& a, const RayMeasurement& b, Cost cost);

// Of the rows, whatever scenes and classes they are of.
bool on_pareto_front(const RayMeasurement& row, std::span<const RayMeasurement> rows, Cost cost);

// The rows of one scene and class that fail no more often than the default (all of them, where there is no default),
// less those that another of them beats in cost and error: ascending in cost, descending in error.
std::vector<RayMeasurement> reliable_front(std::span<const RayMeasurement> rows, Cost cost);

// Whether the default is on the front, for each class of rays of the scene that has it.
struct FrontVerdict {
  std::string ray_class;
  bool on_front = false;
  std::vector<RayMeasurement> dominated_by;  // empty when it is
};
std::vector<FrontVerdict> judge_default(std::span<const RayMeasurement> rows, const std::string& scene, Cost cost);

}  // namespace fathom::runtime
