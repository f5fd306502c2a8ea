// Compiled once for each instruction set and chosen at run time (Highway's foreach_target).
#include "runtime/field/piece_boxes.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "runtime/field/piece_boxes.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace fathom::runtime::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using BoxLanes = hn::CappedTag<float, 16>;

// Replaces the last box ahead, a node's, by those of the node that the ray meets.
void open_node(const PieceBoxes::Node& node, PieceBoxes::Visit& visit) {
  constexpr std::size_t kWidth = PieceBoxes::kWidth;
  const BoxLanes d;
  alignas(64) float entry[kWidth], exit[kWidth];
  const auto margin = hn::Set(d, visit.margin);
  std::uint32_t met = 0;  // bits of the boxes
  for (std::size_t i = 0; i < kWidth; i += hn::Lanes(d)) {
    auto begin = hn::Zero(d), end = hn::Set(d, visit.length);
    for (int axis = 0; axis < 3; ++axis) {
      const auto origin = hn::Set(d, visit.origin[axis]), inverse = hn::Set(d, visit.inverse[axis]);
      const auto lo = hn::Sub(hn::Load(d, node.sides[axis] + i), margin),
                 hi = hn::Add(hn::Load(d, node.sides[axis + 3] + i), margin);
      const auto a = hn::Mul(hn::Sub(lo, origin), inverse), b = hn::Mul(hn::Sub(hi, origin), inverse);
      begin = hn::Max(begin, hn::Min(a, b));
      end = hn::Min(end, hn::Max(a, b));
    }
    hn::Store(begin, d, entry + i);
    hn::Store(end, d, exit + i);
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(d, hn::Le(begin, end), bits);
    met |= static_cast<std::uint32_t>(bits[0] | bits[1] << 8) << i;
  }
  std::vector<BoxedPiece>& ahead = visit.ahead;
  std::size_t size = ahead.size() - 1;
  ahead.resize(size + static_cast<std::size_t>(std::popcount(met)));
  for (; met != 0; met &= met - 1) {
    const auto i = static_cast<std::size_t>(std::countr_zero(met));
    const BoxedPiece box{entry[i], exit[i], node.child[i]};
    std::size_t at = size++;
    for (; at > 0; --at) {
      const BoxedPiece& nearer = ahead[at - 1];
      if (nearer.entry > box.entry || (nearer.entry == box.entry && nearer.piece > box.piece)) break;
      ahead[at] = nearer;
    }
    ahead[at] = box;
  }
}

}  // namespace fathom::runtime::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace fathom::runtime {
namespace {

constexpr float kFar = std::numeric_limits<float>::max();
// Margin of a box, relative to the largest coordinate: the float errors of slabs.
constexpr double kSlabError = 4e-6;

float size_of(const float* sides, int axis) { return sides[axis + 3] - sides[axis]; }

// Half of the surface of a box, as a double: the boxes of planes are endless.
double half_area(const float* sides) {
  const double x = size_of(sides, 0), y = size_of(sides, 1), z = size_of(sides, 2);
  return x * y + y * z + z * x;
}

void enclose(float* around, const float* sides) {
  for (int axis = 0; axis < 3; ++axis) {
    around[axis] = std::min(around[axis], sides[axis]);
    around[axis + 3] = std::max(around[axis + 3], sides[axis + 3]);
  }
}

constexpr float kNothing[6] = {kFar, kFar, kFar, -kFar, -kFar, -kFar};

}  // namespace

HWY_EXPORT(open_node);

PieceBoxes::PieceBoxes(std::span<const compiler::Box> boxes) {
  std::vector<Item> items;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    if (boxes[i].empty()) continue;
    Item item{{}, static_cast<std::int32_t>(i)};
    for (int axis = 0; axis < 3; ++axis) {
      const double lo = boxes[i].lo[axis], hi = boxes[i].hi[axis];
      item.sides[axis] = static_cast<float>(std::max(lo - kSlabError * std::abs(lo), -1e30));
      item.sides[axis + 3] = static_cast<float>(std::min(hi + kSlabError * std::abs(hi), 1e30));
    }
    items.push_back(item);
  }
  add_node(items);
}

// Sorts the items so that the areas of the boxes of two parts, times the parts' sizes, are least. Returns the size of
// the first part.
template <class Item>
std::size_t best_part(std::span<Item> items) {
  std::size_t best = items.size() / 2;
  int best_axis = -1;
  double least = std::numeric_limits<double>::infinity();
  std::vector<double> areas(items.size());
  const auto sort = [&](int axis) {
    std::ranges::sort(items, [axis](const Item& a, const Item& b) {
      const float x = a.sides[axis] + a.sides[axis + 3], y = b.sides[axis] + b.sides[axis + 3];
      return x < y || (x == y && a.child < b.child);
    });
  };
  for (int axis = 0; axis < 3; ++axis) {
    sort(axis);
    float around[6];
    std::ranges::copy(kNothing, around);
    for (std::size_t i = 0; i < items.size(); ++i) {
      enclose(around, items[i].sides);
      areas[i] = half_area(around);
    }
    std::ranges::copy(kNothing, around);
    for (std::size_t i = items.size(); i-- > 1;) {
      enclose(around, items[i].sides);
      const double cost =
          areas[i - 1] * static_cast<double>(i) + half_area(around) * static_cast<double>(items.size() - i);
      if (cost < least) least = cost, best = i, best_axis = axis;
    }
  }
  if (best_axis >= 0) sort(best_axis);
  return best;
}

// Divides more than kWidth items into kWidth parts, the largest box first. Endless boxes are parts of their own.
std::vector<std::span<PieceBoxes::Item>> PieceBoxes::groups_of(std::span<Item> items) {
  const auto endless = [](const Item& item) {
    return std::ranges::any_of(item.sides, [](float side) { return std::abs(side) >= 1e30f; });
  };
  const auto bounded = std::stable_partition(items.begin(), items.end(), endless);
  const auto unbounded = static_cast<std::size_t>(bounded - items.begin());
  std::vector<std::span<Item>> groups;
  if (unbounded <= kWidth / 2) {
    for (std::size_t i = 0; i < unbounded; ++i) groups.push_back(items.subspan(i, 1));
    items = items.subspan(unbounded);
  }
  groups.push_back(items);
  while (groups.size() < kWidth) {
    std::size_t largest = groups.size();
    double area = -1;
    for (std::size_t i = 0; i < groups.size(); ++i) {
      float around[6];
      std::ranges::copy(kNothing, around);
      for (const Item& item : groups[i]) enclose(around, item.sides);
      if (groups[i].size() > 1 && half_area(around) > area) largest = i, area = half_area(around);
    }
    if (largest == groups.size()) break;
    const std::span<Item> group = groups[largest];
    const std::size_t first = best_part(group);
    groups[largest] = group.subspan(0, first);
    groups.push_back(group.subspan(first));
  }
  return groups;
}

// Adds the node of these items after those below it. Returns the child that stands for it.
std::int32_t PieceBoxes::add_node(std::span<Item> items) {
  std::vector<Item> children(items.begin(), items.end());
  if (items.size() > kWidth) {
    children.clear();
    for (const std::span<Item> group : groups_of(items)) {
      Item child = group[0];
      for (const Item& item : group) enclose(child.sides, item.sides);
      if (group.size() > 1) child.child = add_node(group);
      children.push_back(child);
    }
  }
  Node node;
  for (auto& sides : node.sides) std::ranges::fill(sides, kFar);
  std::ranges::fill(node.child, 0);
  for (std::size_t i = 0; i < children.size(); ++i) {
    for (std::size_t side = 0; side < 6; ++side) node.sides[side][i] = children[i].sides[side];
    node.child[i] = children[i].child;
  }
  nodes_.push_back(node);
  return ~static_cast<std::int32_t>(nodes_.size() - 1);
}

void PieceBoxes::begin(glm::dvec3 origin, glm::dvec3 direction, double length, Visit& visit) const {
  // A direction along a slab: so small a part that the ray stays on its side of the slab for all its length.
  constexpr float kLeastPart = 1e-30f;
  for (int axis = 0; axis < 3; ++axis) {
    const auto part = static_cast<float>(direction[axis]);
    visit.origin[axis] = static_cast<float>(origin[axis]);
    visit.inverse[axis] = 1 / (std::abs(part) < kLeastPart ? std::copysign(kLeastPart, part) : part);
  }
  visit.margin = static_cast<float>(kSlabError * compiler::largest_part(origin));
  visit.length = static_cast<float>(std::min(length, 1e30));
  visit.ahead.assign(1, {0, visit.length, ~static_cast<std::int32_t>(nodes_.size() - 1)});
}

bool PieceBoxes::next(Visit& visit, double reach, BoxedPiece& found) const {
  while (!visit.ahead.empty() && static_cast<double>(visit.ahead.back().entry) <= reach) {
    found = visit.ahead.back();
    if (found.piece >= 0) {
      visit.ahead.pop_back();
      return true;
    }
    HWY_DYNAMIC_DISPATCH(open_node)(nodes_[static_cast<std::size_t>(~found.piece)], visit);
  }
  return false;
}

}  // namespace fathom::runtime
#endif  // HWY_ONCE
