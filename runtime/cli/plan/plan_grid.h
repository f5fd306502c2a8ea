// How a plan cuts a render into units, by numbers alone.
// Tested by: tests/runtime/cli/plan/cli_plan_test.cpp
#pragma once

#include <cstdint>
#include <optional>

#include "runtime/base/coverage.h"
#include "runtime/cli/options/frame_options.h"

namespace fathom::cli {

// The cuts of a plan.
struct PlanGrid {
  std::optional<FrameRange> frames;  // nothing: a still
  int width = 0, height = 0;         // pixels
  int columns = 1, rows = 1;         // tiles of a frame
  std::uint32_t spp = 1, block = 1;  // samples of a pixel; of them in a unit

  std::uint64_t frame_count() const { return frames ? static_cast<std::uint64_t>(frames->count()) : 1; }
  std::uint64_t blocks() const { return (spp + block - 1) / block; }
  std::uint64_t units_of_frame() const {
    return static_cast<std::uint64_t>(columns) * static_cast<std::uint64_t>(rows) * blocks();
  }
  std::uint64_t units() const { return frame_count() * units_of_frame(); }
};

constexpr double kMostUnits = 1e9;
bool too_many_units(const PlanGrid& grid);  // their number may not be one of 64 bits

struct PlanUnit {
  int frame_index;  // in the grid's frames; 0 of a still
  runtime::PixelRect area;
  runtime::SampleRange samples;
};

// Units count frame by frame, tile by tile, block by block: neighbours have the scene in common.
PlanUnit unit_of(const PlanGrid& grid, std::uint64_t number);

// Seconds that a unit is to take where nobody says, of a render that takes so many on one machine: two minutes; of
// `machines` a thirtieth of what each has to do, from one minute to five, but no less than a queue takes to start a
// unit for each of them. Source: bench/farm.cpp, which tries others.
double usual_unit_seconds(double all_seconds, std::optional<int> machines);
// Cuts such that a unit takes about so many seconds: tiles first, which add nothing to what is written, down to 64
// pixels a side, unless they are given; blocks of samples then, each of which is written as a film of its own.
void cut(PlanGrid& grid, bool tiles_given, double frame_seconds, double unit_seconds);

}  // namespace fathom::cli
