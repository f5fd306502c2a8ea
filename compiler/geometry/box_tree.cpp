#include "compiler/geometry/box_tree.h"

#include <algorithm>
#include <cstddef>

namespace fathom::compiler {
namespace {

constexpr std::uint32_t kLeaf = 8;  // maximum number of boxes in a leaf, which are tested one by one
constexpr double kEndless = 1e100;  // replaces an infinite side

double middle(const Box& box, int axis) {
  return std::clamp(box.lo[axis], -kEndless, kEndless) + std::clamp(box.hi[axis], -kEndless, kEndless);
}

}  // namespace

BoxTree::BoxTree(std::span<const Box> boxes) : boxes_(boxes) {
  for (std::uint32_t i = 0; i < boxes.size(); ++i) (boxes[i].empty() ? empty_ : order_).push_back(i);
  if (!order_.empty()) build(0, static_cast<std::uint32_t>(order_.size()));
}

// Splits the boxes into halves at the median of their centres, along the axis on which the centres are spread most.
void BoxTree::build(std::uint32_t first, std::uint32_t count) {
  const std::size_t self = nodes_.size();
  nodes_.push_back({{}, first, count, 0});
  const std::span<std::uint32_t> part(order_.data() + first, count);
  Box box, middles;
  for (const std::uint32_t i : part) {
    box = unite(box, boxes_[i]);
    const glm::dvec3 m(middle(boxes_[i], 0), middle(boxes_[i], 1), middle(boxes_[i], 2));
    middles = unite(middles, {m, m});
  }
  nodes_[self].box = box;
  if (count > kLeaf) {
    const glm::dvec3 size = middles.hi - middles.lo;
    const int axis = size.x >= std::max(size.y, size.z) ? 0 : size.y >= size.z ? 1 : 2;
    const std::uint32_t half = count / 2;
    std::nth_element(part.begin(), part.begin() + half, part.end(), [&](std::uint32_t a, std::uint32_t b) {
      const double at_a = middle(boxes_[a], axis), at_b = middle(boxes_[b], axis);
      return at_a != at_b ? at_a < at_b : a < b;
    });
    build(first, half);
    build(first + half, count - half);
  }
  nodes_[self].after = static_cast<std::uint32_t>(nodes_.size());
}

std::size_t BoxTree::find(const Box& box, std::vector<std::uint32_t>& found) const {
  found.assign(empty_.begin(), empty_.end());
  std::size_t looks = empty_.size();
  for (std::uint32_t at = 0; at < nodes_.size();) {
    const Node& node = nodes_[at];
    ++looks;
    if (apart(node.box, box)) {
      at = node.after;
      continue;
    }
    if (node.count <= kLeaf) {
      for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
        if (!apart(boxes_[order_[i]], box)) found.push_back(order_[i]);
      }
      looks += node.count;
    }
    ++at;
  }
  std::sort(found.begin(), found.end());
  return looks;
}

}  // namespace fathom::compiler
