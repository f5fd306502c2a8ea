// The descent, compiled once for each instruction set (Highway's foreach_target).
#include "runtime/region_find.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "runtime/region_find.cpp"
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

class Descent {
 public:
  explicit HWY_INLINE Descent(const RegionTree& tree) : tree_(tree) {}

  // Appends those of the points from `at` on that are in no far leaf to the `size` there are; how many there are
  // then.
  HWY_INLINE std::size_t run(const vm::Points& points, std::size_t at, std::size_t count, float* distance,
                             const NearPoints& near, std::size_t size) {
    const Words words;
    const Batch p[3] = {Batch::load(points.x + at), Batch::load(points.y + at), Batch::load(points.z + at)};
    const Batch zero = Batch::broadcast(0.0f), most = Batch::broadcast(static_cast<float>(1u << tree_.levels));
    BatchMask inside = zero <= zero;
    Word cell[3];
    for (int axis = 0; axis < 3; ++axis) {
      const Batch c = (p[axis] - Batch::broadcast(tree_.lo[axis])) * Batch::broadcast(tree_.scale);
      inside = inside & (c >= zero) & (c < most);
      cell[axis] = hn::BitCast(words, hn::ConvertTo(Ints(), select(inside, c, zero).v));
    }
    const Word one = hn::Set(words, 1u), inner = hn::Set(words, 1u << 30);
    Word shift = hn::Set(words, static_cast<std::uint32_t>(tree_.levels - tree_.grid_level));
    const Word edge = hn::Set(words, 1u << tree_.grid_level);
    Word index = hn::Add(hn::Shr(cell[0], shift),
                         hn::Mul(edge, hn::Add(hn::Shr(cell[1], shift), hn::Mul(edge, hn::Shr(cell[2], shift)))));
    index = hn::Add(index, index);
    Word ref = gather(tree_.nodes + 1, index);
    for (auto deeper = hn::Lt(ref, inner); !hn::AllFalse(words, deeper); deeper = hn::Lt(ref, inner)) {
      shift = hn::IfThenElse(deeper, hn::Sub(shift, one), shift);
      const auto bit = [&](int axis) HWY_ATTR { return hn::And(hn::Shr(cell[axis], shift), one); };
      const Word child = hn::Or(bit(0), hn::Or(hn::ShiftLeft<1>(bit(1)), hn::ShiftLeft<2>(bit(2))));
      const Word next = hn::Add(ref, child);
      index = hn::IfThenElse(deeper, hn::Add(next, next), index);
      ref = gather(tree_.nodes + 1, index);
    }
    const Batch value{hn::BitCast(FloatLanes(), gather(tree_.nodes, index))};
    put_far(p, cell, ref, value, distance + at);
    ref = hn::IfThenElse(hn::RebindMask(words, inside.m), ref, hn::Set(words, kOutside));
    const Word point = hn::Iota(words, static_cast<std::uint32_t>(at));
    const auto is_near = hn::And(hn::Not(hn::Lt(ref, hn::Set(words, kFirstNear))),
                                 hn::Lt(point, hn::Set(words, static_cast<std::uint32_t>(count))));
    hn::StoreU(hn::Compress(point, is_near), words, near.point + size);
    hn::StoreU(hn::Compress(ref, is_near), words, near.ref + size);
    hn::StoreU(hn::Compress(value.v, hn::RebindMask(FloatLanes(), is_near)), FloatLanes(), near.limit + size);
    return size + hn::CountTrue(words, is_near);
  }

 private:
  // The ball round a far cell's centre; of other lanes a number nobody reads.
  HWY_INLINE void put_far(const Batch (&p)[3], const Word (&cell)[3], Word ref, Batch value, float* distance) const {
    const Words words;
    const Word level = hn::And(ref, hn::Set(words, 31u));
    const Word levels = hn::Set(words, static_cast<std::uint32_t>(tree_.levels));
    const Word shift = hn::Sub(levels, hn::Min(level, levels));
    // The root's edge over 2^level: its exponent less the level.
    const Word root = hn::BitCast(words, hn::Set(FloatLanes(), tree_.size));
    const Batch edge{hn::BitCast(FloatLanes(), hn::Sub(root, hn::ShiftLeft<23>(level)))};
    const Batch half = Batch::broadcast(0.5f);
    Batch squared = Batch::broadcast(0.0f);
    for (int axis = 0; axis < 3; ++axis) {
      const Batch at{hn::ConvertTo(FloatLanes(), hn::BitCast(Ints(), hn::Shr(cell[axis], shift)))};
      const Batch d = p[axis] - (Batch::broadcast(tree_.lo[axis]) + (at + half) * edge);
      squared = squared + d * d;
    }
    const Batch ball = value - Batch::broadcast(tree_.lipschitz) * sqrt(squared);
    max(ball, Batch::broadcast(tree_.far) * edge).store(distance);
  }

  const RegionTree& tree_;
};

std::size_t find_all(const RegionTree& tree, vm::Points points, std::size_t count, float* distance,
                     const NearPoints& near) {
  Descent descent(tree);
  std::size_t size = 0;
  for (std::size_t at = 0; at < count; at += kLanes) size = descent.run(points, at, count, distance, near, size);
  return size;
}

}  // namespace fathom::runtime::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace fathom::runtime {

HWY_EXPORT(find_all);

std::size_t find_regions(const RegionTree& tree, vm::Points points, std::size_t count, float* distance,
                         const NearPoints& near) {
  return HWY_DYNAMIC_DISPATCH(find_all)(tree, points, count, distance, near);
}

}  // namespace fathom::runtime
#endif  // HWY_ONCE
