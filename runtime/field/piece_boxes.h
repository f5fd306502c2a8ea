// The boxes of pieces as a tree, and which of them a ray meets, in the order in which it enters them.
//
// A node has up to 16 boxes, which a ray meets all at once, by slabs (Kay and Kajiya, "Ray Tracing Complex Scenes",
// 1986). The tree is built from the top, by the areas of the boxes (Wald, Benthin and Boulos, "Getting Rid of
// Packets", 2008). Pieces and their order depend on the ray and the boxes alone, not on the tree.
// Tested by: tests/runtime/field/piece_boxes_test.cpp
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
  std::int32_t piece;
};

class PieceBoxes {
 public:
  explicit PieceBoxes(std::span<const compiler::Box> boxes = {});

  // A ray's way through the tree.
  struct Visit {
    float origin[3], inverse[3], margin, length;
    // Boxes that the ray enters further on, the nearest last, those of nodes (numbers below 0) after those of pieces,
    // of pieces with one entry that with the lowest number last.
    std::vector<BoxedPiece> ahead;
  };
  // Begins the visit of a ray of this length. The direction has unit length.
  void begin(glm::dvec3 origin, glm::dvec3 direction, double length, Visit& visit) const;
  // Sets `found` to the next piece. Returns false if the ray enters no more pieces within `reach`.
  bool next(Visit& visit, double reach, BoxedPiece& found) const;

  static constexpr std::size_t kWidth = 16;
  struct alignas(64) Node {
    float sides[6][kWidth];      // [lo x, y, z, hi x, y, z][box], padded by points that no ray meets
    std::int32_t child[kWidth];  // number of a piece, or ~number of a node
  };

 private:
  struct Item {
    float sides[6];
    std::int32_t child;
  };
  static std::vector<std::span<Item>> groups_of(std::span<Item> items);
  std::int32_t add_node(std::span<Item> items);

  std::vector<Node> nodes_;  // the last is the root
};

}  // namespace fathom::runtime
