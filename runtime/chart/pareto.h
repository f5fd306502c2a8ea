// Pareto front of the measurements: rows that no other row beats at once in speed, accuracy and reliability.
//
// Rows are comparable only within the same scene and ray class. One row dominates another if its cost, its 99th
// percentile of |t - t_ref| and its failures are no greater and one of the three is less. The reference is excluded
// because its error is 0 by definition, not by measurement. Rows with an unmeasured number are excluded as well.
// Tested by: tests/runtime/chart/chart_pareto_test.cpp
#pragma once

#include <span>
#include <string>
#include <vector>

#include "runtime/chart/measurements.h"

namespace fathom::runtime {

enum class Cost { Time, Evaluations };  // nanoseconds per ray, mean field evaluations per ray
double cost_of(const RayMeasurement& row, Cost cost);

// Sum of false hits, false misses, rays out of steps and gross errors. Contacts are not failures.
double failures_ppm(const RayMeasurement& row);

// Returns the failure rate in ppm that 0 failures of `rays` do not rule out with 95 % confidence, by the rule of
// three (J. Hanley, A. Lippman-Hand, "If Nothing Goes Wrong, Is Everything All Right?", 1983).
double unseen_failures_ppm(std::uint64_t rays);

// True if Fathom renders with the row's method and precision by default.
bool is_default(const RayMeasurement& row);

bool dominates(const RayMeasurement& a, const RayMeasurement& b, Cost cost);

// True if no row dominates `row`. `rows` may contain other scenes and ray classes.
bool on_pareto_front(const RayMeasurement& row, std::span<const RayMeasurement> rows, Cost cost);

// Returns the front in cost and error among the rows that fail no more often than the default (among all rows if
// there is no default), ascending in cost and descending in error. All rows are of one scene and ray class.
std::vector<RayMeasurement> reliable_front(std::span<const RayMeasurement> rows, Cost cost);

// Verdict on the default method for one ray class of the scene.
struct FrontVerdict {
  std::string ray_class;
  bool on_front = false;
  std::vector<RayMeasurement> dominated_by;  // empty if on_front
};
std::vector<FrontVerdict> judge_default(std::span<const RayMeasurement> rows, const std::string& scene, Cost cost);

}  // namespace fathom::runtime
