// Boxes that enclose in spite of rounding.
#pragma once

#include "compiler/geometry/box.h"

namespace fathom::compiler {

// Returns the box moved by `by`, widened by more than the rounding error of its corners.
inline Box moved_outward(const Box& box, glm::dvec3 by) {
  if (by == glm::dvec3(0)) return box;
  const Box moved = box.moved(by);
  return {moved.lo - 0x1p-52 * glm::abs(moved.lo), moved.hi + 0x1p-52 * glm::abs(moved.hi)};
}

}  // namespace fathom::compiler
