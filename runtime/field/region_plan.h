// The layout of a scene's regions (runtime/field/regions.h): a function of the scene alone, no matter if the regions
// are then built. Tested by: tests/runtime/field/regions_test.cpp
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "compiler/geometry/box.h"
#include "runtime/field/far_levels.h"
#include "vm/program/verify.h"

namespace fathom::runtime {

struct RegionPlan {
  std::array<float, 3> lo;            // the root's corner
  float size;                         // the root's edge, scene units
  int levels;                         // levels of cells, the finest last
  int room;                           // the root is 2^room times as long as the scene's bounded parts
  std::size_t choices, instructions;  // numbers in the program
  FarLevels far;
};

// Plans the regions of a program whose bounded parts lie in `contents`. Returns nothing if the program is as fast
// whole (unless `always`), or if the program cannot be cut.
std::optional<RegionPlan> plan_regions(const vm::Code& program, const compiler::Box& contents, int room,
                                       bool always = false);

}  // namespace fathom::runtime
