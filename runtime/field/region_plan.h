// What the regions of a scene are to be like (runtime/field/regions.h): a function of the scene alone, whether they
// are then built or not. Tested by: tests/runtime/field/regions_test.cpp
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
  float size;                         // its edge, scene units
  int levels;                         // of cells, the finest ones last
  int room;                           // the root is 2^room times as long as the scene's bounded parts
  std::size_t choices, instructions;  // of the program
  FarLevels far;
};

// Of a program whose bounded parts lie in `contents`. Nothing when it is as fast whole, unless `always`, or cannot be
// cut.
std::optional<RegionPlan> plan_regions(const vm::Code& program, const compiler::Box& contents, int room,
                                       bool always = false);

}  // namespace fathom::runtime
