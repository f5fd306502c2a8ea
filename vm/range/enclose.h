// Bounds of the f32 results over boxes of points, sixteen boxes at once: of the program's result and of the operands
// of every choice. With these bounds a program can be pruned to a box without changing a bit of its results.
//
//     vm::enclose(program, boxes, lo, hi, choices, workspace);
//     if (choices[i].a_hi[box] < choices[i].b_lo[box]) ...    // only a matters if choice i is a min
//
// The bounds hold for the rounded f32 results at every finite f32 point of the closed box. A value that may be NaN at
// one of these points, or is unknown, has the bounds [-inf, inf]. No bound is NaN; -0 and 0 count as equal. Boxes may
// be unbounded or flat, but not empty. Bounds have the same bits on every instruction set. Source: Moore, "Interval
// Analysis", 1966.
//
// Tested by: tests/vm/range/enclosure_test.cpp, tests/vm/prune/choices_test.cpp
#pragma once

#include <cstddef>
#include <vector>

#include "vm/interpret/workspace.h"
#include "vm/program/verify.h"
#include "vm/range/choice_bounds.h"

namespace fathom::vm {

// Corners of kEnclosedBoxes boxes in scene units. [axis][box]
struct Boxes {
  const float* lo[3];
  const float* hi[3];
};

// Computes the bounds [lo[box], hi[box]] of the result, in arrays of kEnclosedBoxes. `choices` gets one entry per
// instruction with is_choice() (vm/program/opcode.h), in program order; reuse the vector to save allocations.
void enclose(const Code& program, const Boxes& boxes, float* lo, float* hi, std::vector<ChoiceBounds>& choices,
             Workspace& workspace);

}  // namespace fathom::vm
