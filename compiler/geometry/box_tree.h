// A bounding box hierarchy, which finds the boxes that may intersect a box without testing all of them.
// Tested by: tests/compiler/geometry/box_tree_test.cpp
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "compiler/geometry/box.h"

namespace fathom::compiler {

// True if the boxes share no point. False if either is empty, because an empty box has no place.
inline bool apart(const Box& a, const Box& b) {
  const Box both = intersect(a, b);
  return both.empty() && !(a.empty() || b.empty());
}

class BoxTree {
 public:
  explicit BoxTree(std::span<const Box> boxes);

  // Sets `found` to the numbers of the boxes that are not apart from `box`, in ascending order. Returns the number of
  // boxes and tree nodes tested.
  std::size_t find(const Box& box, std::vector<std::uint32_t>& found) const;

 private:
  struct Node {
    Box box;                     // around all boxes of the node
    std::uint32_t first, count;  // range of order_
    std::uint32_t after;         // the next node that is not below this node
  };
  void build(std::uint32_t first, std::uint32_t count);

  std::span<const Box> boxes_;
  std::vector<std::uint32_t> order_;  // numbers of the boxes that are not empty, sorted by the tree
  std::vector<std::uint32_t> empty_;  // numbers of the empty boxes, which every find() returns
  std::vector<Node> nodes_;           // depth first: a node's first child follows the node
};

}  // namespace fathom::compiler
