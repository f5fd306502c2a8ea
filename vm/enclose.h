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
// Tested by: tests/vm/enclosure_test.cpp, tests/vm/choices_test.cpp, tests/vm/nonexpansive_test.cpp
#pragma once

#include <cstddef>
#include <vector>

#include "vm/evaluate.h"

namespace fathom::vm {

// Whether a Shape or Outline never changes faster than its point moves, |f(p) - f(q)| <= |p - q|, and whether a Point
// row moves no two points further apart; at all finite points, given immediates as the compiler derives
// them.
constexpr bool is_nonexpansive(Opcode opcode) {
  switch (opcode) {
    case Opcode::Mandelbulb:  // estimates
    case Opcode::Julia:
    case Opcode::Gyroid:  // where the angles are too large for floats they jump (vm/number/elementary-inl.h)
    case Opcode::SchwarzP:
    case Opcode::SchwarzD:
    case Opcode::Affine:
    case Opcode::Revolve:  // does in the plane of its outlines; it leaves the z they ignore
    case Opcode::Cell:
    case Opcode::CellJitter:
    case Opcode::Sector:
    case Opcode::Twist:
    case Opcode::Bend:
    case Opcode::Taper:
      return false;
    default:
      return true;
  }
}

inline constexpr std::size_t kEnclosedBoxes = 16;  // at once

// Arrays of kEnclosedBoxes, scene units. [axis][box]
struct Boxes {
  const float* lo[3];
  const float* hi[3];
};

// What the operands of a choice can be, `b` being the upper one of the stack, or a joined shape. [box]
struct ChoiceBounds {
  alignas(64) float a_lo[kEnclosedBoxes];
  alignas(64) float a_hi[kEnclosedBoxes];
  alignas(64) float b_lo[kEnclosedBoxes];
  alignas(64) float b_hi[kEnclosedBoxes];
};

// The same in one box.
struct ChoiceRange {
  float a_lo, a_hi, b_lo, b_hi;
};

// The result is within [lo[box], hi[box]], arrays of kEnclosedBoxes. `choices` gets one entry for each instruction
// that is_choice() (vm/opcode.h), in program order; kept between calls, it is not allocated anew.
void enclose(const Code& program, const Boxes& boxes, float* lo, float* hi, std::vector<ChoiceBounds>& choices,
             Workspace& workspace);

// evaluate_slope(), and the ranges of every choice's operands. These hold for f32 as above and for the exact
// values, the program's constants unrounded; both at points where every operation of the program is defined.
SlopeBound enclose_slope(const Code& program, glm::dvec3 lo, glm::dvec3 hi, std::vector<ChoiceRange>& choices,
                         Workspace& workspace);

}  // namespace fathom::vm
