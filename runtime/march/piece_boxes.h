// The boxes of pieces, and which of them a ray meets.
//
// By slabs: Kay and Kajiya, "Ray Tracing Complex Scenes", 1986. Not a public header: march.h is.
// Tested by: tests/runtime/march/piece_marcher_test.cpp
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "compiler/geometry/box.h"

namespace fathom::runtime {

// The part of a ray within a piece's box, in distances from the ray's origin.
struct BoxedPiece {
  float entry, exit;
  std::uint32_t piece;
};

class PieceBoxes {
 public:
  explicit PieceBoxes(std::span<const compiler::Box> boxes);

  // Sets `found` to the boxes that the ray meets within `length`, by entry, those with one entry by number. The
  // direction has unit length.
  void find(glm::dvec3 origin, glm::dvec3 direction, double length, std::vector<BoxedPiece>& found) const;

  std::size_t size() const { return size_; }

 private:
  std::size_t size_;
  std::vector<float> sides_[6];  // [lo x, y, z, hi x, y, z][piece], padded by points that no ray meets
};

}  // namespace fathom::runtime
