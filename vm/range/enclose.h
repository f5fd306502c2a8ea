// What the f32 machine can compute over boxes of points, sixteen boxes at once: for the result and for the operands
// of every choice, so that a program can be cut down to what matters in a box without changing a bit.
//
//     vm::enclose(program, boxes, lo, hi, choices, workspace);
//     if (choices[i].a_hi[box] < choices[i].b_lo[box]) ...    // of a min only a matters in that box
//
// The bounds hold for the machine's own rounded results, at every finite f32 point of the closed box. What may be NaN
// at one of them, and what nothing is known of, has the bounds [-inf, inf]. No bound is NaN; -0 and 0 count as equal.
// Boxes may be unbounded and flat, not empty. Same bits on every instruction set. Source: Moore, "Interval Analysis",
// 1966.
//
// Tested by: tests/vm/range/enclosure_test.cpp, tests/vm/prune/choices_test.cpp
#pragma once

#include <cstddef>
#include <vector>

#include "vm/interpret/workspace.h"
#include "vm/program/verify.h"
#include "vm/range/choice_bounds.h"

namespace fathom::vm {

// Arrays of kEnclosedBoxes, scene units. [axis][box]
struct Boxes {
  const float* lo[3];
  const float* hi[3];
};

// The result is within [lo[box], hi[box]], arrays of kEnclosedBoxes. `choices` gets one entry for each instruction
// that is_choice() (vm/program/opcode.h), in program order; kept between calls, it is not allocated anew.
void enclose(const Code& program, const Boxes& boxes, float* lo, float* hi, std::vector<ChoiceBounds>& choices,
             Workspace& workspace);

}  // namespace fathom::vm
