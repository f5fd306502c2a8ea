// Forecast of what an octree of regions costs and saves, from a sample of its cells. Cutting a program to a cell
// costs as much as evaluating it at two thousand points, so regions are built only where the forecast says that they
// pay. Tested by: tests/runtime/field/region_forecast_test.cpp
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "runtime/field/region_splitter.h"
#include "runtime/field/regions.h"

namespace fathom::runtime {

// A tree whose leaves have at most `choice_factor` times the normal number of choices.
struct RegionForecast {
  std::uint32_t choice_factor;
  double work;    // instructions evaluated by intervals to build the tree
  double length;  // mean instructions of a leaf that is not far
};

// Costs in evaluations of one instruction of the whole program at one point, all lanes full. Measured on scenes of
// bench/region-costs and bench/culling.cpp, between which they vary by a factor of 2 to 4.
// kCutCost: of an instruction that is evaluated by intervals, in the cells of a register, and cut.
// kLookupCost, kLeafCost: of an evaluation in a leaf, and of an instruction there, with few points per program.
inline constexpr double kCutCost = 2000, kLookupCost = 50, kLeafCost = 40;

// True if leaves of a program of so many choices may be `choice_factor` times longer than normal.
bool allows_leaves(std::uint32_t choice_factor, std::size_t choices);

class RegionSurvey {
 public:
  // Bounds the cells around sample points, on every level.
  RegionSurvey(const vm::PrunedProgram& whole, const SplitRules& rules, RegionBudget& budget);

  RegionForecast forecast(std::uint32_t choice_factor) const;

  // Returns the forecast with the least cost of building and evaluating together, or nothing if options.evaluations
  // evaluations do not repay the building (unless options.always).
  std::optional<RegionForecast> best() const;

  // True if options.evaluations evaluations repay the building of this tree, or need not.
  bool pays(const RegionForecast& forecast) const;

  // Instructions that the survey itself evaluates by intervals.
  static double cost(const RegionTree& tree, std::size_t instructions);

 private:
  struct Cell {
    bool far;
    std::uint32_t choices;  // left in the cell's part
  };
  double length_of(std::uint32_t choices) const;
  bool is_limited() const { return std::isfinite(options_.evaluations) && !options_.always; }
  double cost_of(const RegionForecast& forecast) const;

  const RegionOptions& options_;
  const int levels_;
  const double choices_, instructions_;                              // of the whole program
  std::vector<std::array<Cell, vm::kEnclosedBoxes>> cells_;  // [level][sample]
};

}  // namespace fathom::runtime
