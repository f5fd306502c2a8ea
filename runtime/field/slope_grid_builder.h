// Builds the grid of slope bounds: bounds the program in cells, level by level, and divides the cells where finer
// bounds allow longer steps. Not a public header: slope_cells.h is.
// Tested by: tests/runtime/field/slope_cells_test.cpp
#pragma once

#include <cstdint>
#include <vector>

#include "compiler/geometry/box.h"
#include "vm/program/verify.h"

namespace fathom::runtime {

// Bounds of the field in the cells of one level, [z][y][x].
struct SlopeLevel {
  std::vector<float> slopes;  // infinite: no bound
  std::vector<float> errors;  // of float values, over the slope, scene units; only where a zero may be, otherwise 0
  std::vector<std::uint8_t> free;  // 1: the cell holds no zero
};

// Returns levels 0, 1, ... of a grid over `box`, at most `levels`. Cells that are not divided pass their bounds on.
std::vector<SlopeLevel> build_slope_levels(const vm::VerifiedProgram& program, const compiler::Box& box, int levels);

}  // namespace fathom::runtime
