// The descent through the octree, compiled once for each instruction set (Highway's foreach_target).
#include "runtime/field/region_find.h"

#include <array>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "runtime/field/region_find.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "vm/number/batch-inl.h"

HWY_BEFORE_NAMESPACE();
namespace fathom::runtime::HWY_NAMESPACE {

using namespace vm::HWY_NAMESPACE;
using Words = hn::RebindToUnsigned<FloatLanes>;
using Ints = hn::RebindToSigned<FloatLanes>;
using Word = hn::Vec<Words>;

HWY_INLINE Word gather(const std::uint32_t* from, Word index) {
  return hn::GatherIndex(Words(), from, hn::BitCast(Ints(), index));
}

// Moves all points down together, one level at a time, so that the nodes they need are requested from memory early.
class TreeDescent {
 public:
  explicit HWY_INLINE TreeDescent(const RegionTree& tree) : tree_(tree) {}

  HWY_INLINE LookupResult run(const vm::Points& points, std::size_t count, float* distance, const NearPoints& near) {
    for (std::size_t at = 0; at < count; at += kLanes) begin(points, at);
    std::size_t going = (count + kLanes - 1) / kLanes;
    for (std::size_t i = 0; i < going; ++i) going_[i] = static_cast<std::uint16_t>(i * kLanes);
    while (going > 0) {
      std::size_t left = 0;
      for (std::size_t i = 0; i < going; ++i) {
        going_[left] = going_[i];
        left += go_down(going_[i]);
      }
      going = left;
    }
    std::size_t size = 0;
    for (std::size_t at = 0; at < count; at += kLanes) size = finish(at, count, distance, near, size);
    return {size, !hn::AllFalse(Words(), outside_)};
  }

 private:
  // Computes the points' cells and starts at their nodes of the grid.
  HWY_INLINE void begin(const vm::Points& points, std::size_t at) {
    const Words words;
    const Batch p[3] = {Batch::load(points.x + at), Batch::load(points.y + at), Batch::load(points.z + at)};
    const Batch zero = Batch::broadcast(0.0f), most = Batch::broadcast(static_cast<float>(1u << tree_.levels));
    BatchMask inside = zero <= zero;
    Word cell[3];
    for (int axis = 0; axis < 3; ++axis) {
      const Batch c = (p[axis] - Batch::broadcast(tree_.lo[axis])) * Batch::broadcast(tree_.scale);
      inside = inside & (c >= zero) & (c < most);
      cell[axis] = hn::BitCast(words, hn::ConvertTo(Ints(), select(inside, c, zero).v));
      hn::Store(cell[axis], words, &cell_[axis][at]);
    }
    const int shift = tree_.levels - tree_.grid_level;
    const Word edge = hn::Set(words, 1u << tree_.grid_level);
    const auto in_grid = [&](int axis) HWY_ATTR { return hn::ShiftRightSame(cell[axis], shift); };
    const Word index = hn::Add(in_grid(0), hn::Mul(edge, hn::Add(in_grid(1), hn::Mul(edge, in_grid(2)))));
    const auto is_inside = hn::RebindMask(words, inside.m);
    hn::Store(hn::Set(words, static_cast<std::uint32_t>(shift)), words, &shift_[at]);
    hn::Store(hn::IfThenElseZero(is_inside, hn::Set(words, ~0u)), words, &inside_[at]);
    look_at(hn::Add(index, index), at);
  }

  // Moves the points of a register down by one level. True if any of them has to go on.
  HWY_INLINE bool go_down(std::size_t at) {
    const Words words;
    const Word one = hn::Set(words, 1u), index = hn::Load(words, &index_[at]), ref = gather(tree_.nodes + 1, index);
    const auto deeper = hn::Lt(ref, hn::Set(words, 1u << 30));
    hn::Store(ref, words, &ref_[at]);
    if (hn::AllFalse(words, deeper)) return false;
    const Word before = hn::Load(words, &shift_[at]), shift = hn::IfThenElse(deeper, hn::Sub(before, one), before);
    hn::Store(shift, words, &shift_[at]);
    const auto bit = [&](int axis)
                         HWY_ATTR { return hn::And(hn::Shr(hn::Load(words, &cell_[axis][at]), shift), one); };
    const Word child = hn::Or(bit(0), hn::Or(hn::ShiftLeft<1>(bit(1)), hn::ShiftLeft<2>(bit(2))));
    const Word next = hn::Add(ref, child);
    look_at(hn::IfThenElse(deeper, hn::Add(next, next), index), at);
    return true;
  }

  HWY_INLINE void look_at(Word index, std::size_t at) {
    hn::Store(index, Words(), &index_[at]);
    if (!tree_.beyond_cache) return;
    for (std::size_t lane = 0; lane < kLanes; ++lane) __builtin_prefetch(tree_.nodes + index_[at + lane]);
  }

  // Appends the points of the register at `at` that are in no far leaf to `near`, which holds `size` of them. Returns
  // the new size.
  HWY_INLINE std::size_t finish(std::size_t at, std::size_t count, float* distance, const NearPoints& near,
                                std::size_t size) {
    const Words words;
    const Batch value{hn::BitCast(FloatLanes(), gather(tree_.nodes, hn::Load(words, &index_[at])))};
    const auto inside = hn::Ne(hn::Load(words, &inside_[at]), hn::Zero(words));
    Word ref = hn::Load(words, &ref_[at]);
    value.store(distance + at);
    ref = hn::IfThenElse(inside, ref, hn::Set(words, kOutside));
    const Word point = hn::Iota(words, static_cast<std::uint32_t>(at));
    const auto is_near = hn::And(hn::Not(hn::Lt(ref, hn::Set(words, kFirstNear))),
                                 hn::Lt(point, hn::Set(words, static_cast<std::uint32_t>(count))));
    hn::StoreU(hn::Compress(point, is_near), words, near.point + size);
    hn::StoreU(hn::Compress(ref, is_near), words, near.ref + size);
    hn::StoreU(hn::Compress(value.v, hn::RebindMask(FloatLanes(), is_near)), FloatLanes(), near.limit + size);
    outside_ = hn::Or(outside_, hn::AndNot(inside, is_near));
    return size + hn::CountTrue(words, is_near);
  }

  template <class T>
  using PerPoint = std::array<T, kMaxPoints>;

  const RegionTree& tree_;
  alignas(64) PerPoint<std::uint32_t> cell_[3];  // in finest cells
  // Per point: its current node, as an index of words; the size of the node's cell, as a shift of finest cells; the
  // node's word; 0 if the point is outside the root.
  alignas(64) PerPoint<std::uint32_t> index_, shift_, ref_, inside_;
  PerPoint<std::uint16_t> going_;  // first points of the registers in which a point must go on
  hn::Mask<Words> outside_ = hn::FirstN(Words(), 0);
};

LookupResult find_all(const RegionTree& tree, vm::Points points, std::size_t count, float* distance,
                      const NearPoints& near) {
  return TreeDescent(tree).run(points, count, distance, near);
}

}  // namespace fathom::runtime::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace fathom::runtime {

HWY_EXPORT(find_all);

LookupResult find_regions(const RegionTree& tree, vm::Points points, std::size_t count, float* distance,
                          const NearPoints& near) {
  return HWY_DYNAMIC_DISPATCH(find_all)(tree, points, count, distance, near);
}

}  // namespace fathom::runtime
#endif  // HWY_ONCE
