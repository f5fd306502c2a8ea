// The division of a plan's render into units, by numbers only.
// Tested by: tests/runtime/cli/plan/cli_plan_test.cpp
#pragma once

#include <cstdint>
#include <optional>

#include "runtime/base/coverage.h"
#include "runtime/cli/options/frame_options.h"

namespace fathom::cli {

// Numbers of tiles and sample blocks into which a plan cuts its frames.
struct PlanGrid {
  std::optional<FrameRange> frames;  // nullopt: a still
  int width = 0, height = 0;         // pixels
  int columns = 1, rows = 1;         // tiles per frame
  std::uint32_t spp = 1, block = 1;  // samples per pixel of the render and of a unit

  std::uint64_t frame_count() const { return frames ? static_cast<std::uint64_t>(frames->count()) : 1; }
  std::uint64_t blocks() const { return (spp + block - 1) / block; }
  std::uint64_t units_of_frame() const {
    return static_cast<std::uint64_t>(columns) * static_cast<std::uint64_t>(rows) * blocks();
  }
  std::uint64_t units() const { return frame_count() * units_of_frame(); }
};

constexpr double kMaxUnits = 1e9;
bool too_many_units(const PlanGrid& grid);  // computes in double: the number may exceed 64 bits

struct PlanUnit {
  int frame_index;  // index into the grid's frames; 0 for a still
  runtime::PixelRect area;
  runtime::SampleRange samples;
};

// Returns the unit with this number. Units are numbered frame by frame, tile by tile, block by block, so that
// neighbours share the scene.
PlanUnit unit_of(const PlanGrid& grid, std::uint64_t number);

// Returns the default duration of a unit in seconds, for a render that takes `all_seconds` on one machine. Without
// `machines` the duration is two minutes. Otherwise the duration is a thirtieth of a machine's share, clamped to one
// to five minutes, but no less than a queue needs to start one unit per machine. Source: bench/farm.cpp, which
// compares other values.
double default_unit_seconds(double all_seconds, std::optional<int> machines);
// Cuts the grid such that a unit takes about `unit_seconds`. Unless `tiles_given`, tiles are cut first, down to 64
// pixels per side, because tiles do not add to the written data. Blocks of samples are cut next, because each block
// is written as a film of its own.
void cut(PlanGrid& grid, bool tiles_given, double frame_seconds, double unit_seconds);

}  // namespace fathom::cli
