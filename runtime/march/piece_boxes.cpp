// Compiled once for each instruction set and chosen at run time (Highway's foreach_target).
#include "runtime/march/piece_boxes.h"

#include <algorithm>
#include <cmath>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "runtime/march/piece_boxes.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace fathom::runtime::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using BoxLanes = hn::CappedTag<float, 16>;

// Writes the number, the entry and the exit of each of `count` boxes that the ray meets. Returns how many.
std::size_t meet(const float* const* sides, std::size_t count, const float* origin, const float* inverse,
                 float margin, float length, std::uint32_t* number, float* entry, float* exit) {
  const BoxLanes d;
  const hn::RebindToUnsigned<BoxLanes> u;
  const auto reach = hn::Set(d, margin);
  std::size_t met = 0;
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    auto begin = hn::Zero(d), end = hn::Set(d, length);
    for (int axis = 0; axis < 3; ++axis) {
      const auto o = hn::Set(d, origin[axis]), k = hn::Set(d, inverse[axis]);
      const auto lo = hn::Sub(hn::LoadU(d, sides[axis] + i), reach),
                 hi = hn::Add(hn::LoadU(d, sides[axis + 3] + i), reach);
      const auto a = hn::Mul(hn::Sub(lo, o), k), b = hn::Mul(hn::Sub(hi, o), k);
      begin = hn::Max(begin, hn::Min(a, b));
      end = hn::Min(end, hn::Max(a, b));
    }
    const auto meets = hn::Le(begin, end);
    if (hn::AllFalse(d, meets)) continue;
    hn::CompressStore(hn::Iota(u, static_cast<std::uint32_t>(i)), hn::RebindMask(u, meets), u, number + met);
    hn::CompressStore(begin, meets, d, entry + met);
    met += hn::CompressStore(end, meets, d, exit + met);
  }
  return met;
}

}  // namespace fathom::runtime::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace fathom::runtime {
namespace {

constexpr std::size_t kPadding = 16;

// Margin of a box, relative to the largest coordinate: the float errors of slabs.
constexpr double kSlabError = 4e-6;

}  // namespace

HWY_EXPORT(meet);

PieceBoxes::PieceBoxes(std::span<const compiler::Box> boxes) : size_(boxes.size()) {
  constexpr float kFar = std::numeric_limits<float>::max();
  const std::size_t padded = (size_ + kPadding - 1) / kPadding * kPadding;
  for (int axis = 0; axis < 3; ++axis) {
    sides_[axis].assign(padded, kFar);
    sides_[axis + 3].assign(padded, kFar);
    for (std::size_t i = 0; i < size_; ++i) {
      if (boxes[i].empty()) continue;
      const double lo = boxes[i].lo[axis], hi = boxes[i].hi[axis];
      sides_[axis][i] = static_cast<float>(std::max(lo - kSlabError * std::abs(lo), static_cast<double>(-kFar)));
      sides_[axis + 3][i] = static_cast<float>(std::min(hi + kSlabError * std::abs(hi), static_cast<double>(kFar)));
    }
  }
}

void PieceBoxes::find(glm::dvec3 origin, glm::dvec3 direction, double length, std::vector<BoxedPiece>& found) const {
  constexpr std::size_t kMost = 1024;
  alignas(64) std::uint32_t number[kMost + kPadding];
  alignas(64) float entry[kMost + kPadding], exit[kMost + kPadding];
  // A direction along a slab: so small a part that the ray stays on its side of the slab for all its length.
  constexpr double kLeastPart = 1e-30;
  float from[3], inverse[3];
  for (int axis = 0; axis < 3; ++axis) {
    const double part = direction[axis];
    from[axis] = static_cast<float>(origin[axis]);
    inverse[axis] = static_cast<float>(1 / (std::abs(part) < kLeastPart ? std::copysign(kLeastPart, part) : part));
  }
  const auto margin = static_cast<float>(kSlabError * compiler::largest_part(origin));
  const auto end = static_cast<float>(std::min(length, 1e30));
  found.clear();
  for (std::size_t first = 0; first < sides_[0].size(); first += kMost) {
    const float* const sides[6] = {&sides_[0][first], &sides_[1][first], &sides_[2][first],
                                   &sides_[3][first], &sides_[4][first], &sides_[5][first]};
    const std::size_t count = std::min(kMost, sides_[0].size() - first);
    const std::size_t met = HWY_DYNAMIC_DISPATCH(meet)(sides, count, from, inverse, margin, end, number, entry, exit);
    for (std::size_t i = 0; i < met; ++i)
      found.push_back({entry[i], exit[i], static_cast<std::uint32_t>(first) + number[i]});
  }
  std::ranges::sort(found, [](const BoxedPiece& a, const BoxedPiece& b) {
    return a.entry < b.entry || (a.entry == b.entry && a.piece < b.piece);
  });
}

}  // namespace fathom::runtime
#endif  // HWY_ONCE
