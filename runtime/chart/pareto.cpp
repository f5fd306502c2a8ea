#include "runtime/chart/pareto.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

namespace fathom::runtime {
namespace {

bool takes_part(const RayMeasurement& row, Cost cost) {
  return !row.reference && std::isfinite(cost_of(row, cost)) && std::isfinite(row.terr_p99) &&
         std::isfinite(failures_ppm(row));
}

}  // namespace

double cost_of(const RayMeasurement& row, Cost cost) { return cost == Cost::Time ? row.ns_med : row.evals_mean; }

double failures_ppm(const RayMeasurement& row) {
  return row.false_hit_ppm + row.false_miss_ppm + row.exhausted_ppm + row.gross_ppm;
}

double unseen_failures_ppm(std::uint64_t rays) {
  constexpr double kEventsNotRuledOut = 3;  // -ln 0.05
  return rays == 0 ? 1e6 : std::min(1e6, 1e6 * kEventsNotRuledOut / static_cast<double>(rays));
}

bool is_default(const RayMeasurement& row) {
  return row.method == kDefaultMethod && row.precision == "f32" && !row.reference;
}

bool dominates(const RayMeasurement& a, const RayMeasurement& b, Cost cost) {
  if (a.scene != b.scene || a.ray_class != b.ray_class) return false;
  if (!takes_part(a, cost) || !takes_part(b, cost)) return false;
  const double of_a[] = {cost_of(a, cost), a.terr_p99, failures_ppm(a)};
  const double of_b[] = {cost_of(b, cost), b.terr_p99, failures_ppm(b)};
  bool less = false;
  for (std::size_t i = 0; i < std::size(of_a); ++i) {
    if (of_a[i] > of_b[i]) return false;
    less |= of_a[i] < of_b[i];
  }
  return less;
}

bool on_pareto_front(const RayMeasurement& row, std::span<const RayMeasurement> rows, Cost cost) {
  return takes_part(row, cost) && std::none_of(rows.begin(), rows.end(), [&](const RayMeasurement& other) {
           return dominates(other, row, cost);
         });
}

std::vector<RayMeasurement> reliable_front(std::span<const RayMeasurement> rows, Cost cost) {
  double limit = -1;  // ppm
  for (const RayMeasurement& row : rows) {
    if (is_default(row) && takes_part(row, cost)) limit = std::max(limit, failures_ppm(row));
  }
  if (limit < 0) limit = std::numeric_limits<double>::infinity();
  std::vector<RayMeasurement> reliable;
  std::copy_if(rows.begin(), rows.end(), std::back_inserter(reliable),
               [&](const RayMeasurement& row) { return takes_part(row, cost) && failures_ppm(row) <= limit; });
  std::stable_sort(reliable.begin(), reliable.end(), [&](const RayMeasurement& a, const RayMeasurement& b) {
    return std::pair(cost_of(a, cost), a.terr_p99) < std::pair(cost_of(b, cost), b.terr_p99);
  });
  std::vector<RayMeasurement> front;
  for (const RayMeasurement& row : reliable) {
    if (front.empty() || row.terr_p99 < front.back().terr_p99) front.push_back(row);
  }
  return front;
}

std::vector<FrontVerdict> judge_default(std::span<const RayMeasurement> rows, const std::string& scene, Cost cost) {
  std::vector<FrontVerdict> verdicts;
  for (const RayMeasurement& row : rows) {
    if (row.scene != scene || !is_default(row)) continue;
    FrontVerdict verdict{row.ray_class, on_pareto_front(row, rows, cost), {}};
    std::copy_if(rows.begin(), rows.end(), std::back_inserter(verdict.dominated_by),
                 [&](const RayMeasurement& other) { return dominates(other, row, cost); });
    verdicts.push_back(std::move(verdict));
  }
  return verdicts;
}

}  // namespace fathom::runtime
