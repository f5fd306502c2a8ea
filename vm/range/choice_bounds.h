// Bounds of the operands of a program's choices over boxes of points.
#pragma once

#include <cstddef>

namespace fathom::vm {

inline constexpr std::size_t kEnclosedBoxes = 16;  // number of boxes per call of enclose() (vm/range/enclose.h)

// Ranges of a choice's operands. `b` is the upper operand on the stack, or a joined shape. [box]
struct ChoiceBounds {
  alignas(64) float a_lo[kEnclosedBoxes];
  alignas(64) float a_hi[kEnclosedBoxes];
  alignas(64) float b_lo[kEnclosedBoxes];
  alignas(64) float b_hi[kEnclosedBoxes];
};

// Ranges of a choice's operands in one box.
struct ChoiceRange {
  float a_lo, a_hi, b_lo, b_hi;
};

}  // namespace fathom::vm
