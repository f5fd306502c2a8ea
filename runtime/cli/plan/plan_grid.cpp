#include "runtime/cli/plan/plan_grid.h"

#include <algorithm>
#include <cmath>

namespace fathom::cli {
namespace {

constexpr double kUnitSeconds = 120, kMinUnitSeconds = 60, kMaxUnitSeconds = 300;
// So many that the machines wait only a small part of the time for the last unit.
constexpr double kUnitsPerMachine = 30;
constexpr double kStartsPerSecond = 200;  // units that a queue can start per second
constexpr int kMinTile = 64;              // pixels per side

int edge(int length, int parts, int at) { return static_cast<int>(static_cast<std::int64_t>(length) * at / parts); }

}  // namespace

bool too_many_units(const PlanGrid& grid) {
  const double blocks = std::ceil(static_cast<double>(grid.spp) / std::max(grid.block, 1u));
  return static_cast<double>(grid.frame_count()) * grid.columns * grid.rows * blocks > kMaxUnits;
}

PlanUnit unit_of(const PlanGrid& grid, std::uint64_t number) {
  const std::uint64_t frame = number / grid.units_of_frame(), within = number % grid.units_of_frame();
  const auto tile = static_cast<int>(within / grid.blocks()), block = static_cast<int>(within % grid.blocks());
  const int column = tile % grid.columns, row = tile / grid.columns;
  const std::uint32_t first = static_cast<std::uint32_t>(block) * grid.block;
  return {static_cast<int>(frame),
          {edge(grid.width, grid.columns, column), edge(grid.height, grid.rows, row),
           edge(grid.width, grid.columns, column + 1), edge(grid.height, grid.rows, row + 1)},
          {first, std::min(first + grid.block, grid.spp)}};
}

double default_unit_seconds(double all_seconds, std::optional<int> machines) {
  if (!machines) return kUnitSeconds;
  const double each = all_seconds / *machines / kUnitsPerMachine;
  return std::max(std::clamp(each, kMinUnitSeconds, kMaxUnitSeconds), *machines / kStartsPerSecond);
}

void cut(PlanGrid& grid, bool tiles_given, double frame_seconds, double unit_seconds) {
  const double wanted = std::max(1.0, frame_seconds / unit_seconds);
  if (!tiles_given) {
    const double max_columns = std::max(1, grid.width / kMinTile), max_rows = std::max(1, grid.height / kMinTile);
    grid.columns =
        static_cast<int>(std::clamp(std::round(std::sqrt(wanted * grid.width / grid.height)), 1.0, max_columns));
    grid.rows = static_cast<int>(std::clamp(std::round(wanted / grid.columns), 1.0, max_rows));
  }
  const double blocks = std::round(wanted / grid.columns / grid.rows);
  grid.block =
      static_cast<std::uint32_t>(std::ceil(grid.spp / std::clamp(blocks, 1.0, static_cast<double>(grid.spp))));
}

}  // namespace fathom::cli
