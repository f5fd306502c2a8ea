// Bounds of the operands that a program's choices choose from, over boxes of points.
#pragma once

#include <cstddef>

namespace fathom::vm {

inline constexpr std::size_t kEnclosedBoxes = 16;  // that enclose() takes at once (vm/range/enclose.h)

// The ranges of a choice's operands, `b` being the upper one of the stack, or a joined shape. [box]
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

}  // namespace fathom::vm
