// A tree over boxes that finds those which may meet a box without looking at all of them.
// Tested by: tests/compiler/geometry/box_tree_test.cpp
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "compiler/geometry/box.h"

namespace fathom::compiler {

// Whether the boxes share no point; false when one of them is empty, for an empty box has no place.
inline bool apart(const Box& a, const Box& b) {
  const Box both = intersect(a, b);
  return both.empty() && !(a.empty() || b.empty());
}

class BoxTree {
 public:
  explicit BoxTree(std::span<const Box> boxes);

  // Sets `found` to the numbers of the boxes that are not apart from `box`, in ascending order. Returns how many boxes
  // and nodes of the tree were looked at.
  std::size_t find(const Box& box, std::vector<std::uint32_t>& found) const;

 private:
  struct Node {
    Box box;                     // round all its boxes
    std::uint32_t first, count;  // in order_
    std::uint32_t after;         // the next node that is not below this one
  };
  void build(std::uint32_t first, std::uint32_t count);

  std::span<const Box> boxes_;
  std::vector<std::uint32_t> order_;  // numbers of the boxes that are not empty
  std::vector<std::uint32_t> empty_;  // and of those that are
  std::vector<Node> nodes_;           // a node's first child follows it
};

}  // namespace fathom::compiler
