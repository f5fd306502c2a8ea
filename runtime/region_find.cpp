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

  HWY_INLINE void run(const vm::Points& points, std::size_t at, std::uint32_t* refs, float* values, float* distance) {
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
    index = gather(tree_.grid, index);
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
    value.store(values + at);
    hn::StoreU(hn::IfThenElse(hn::RebindMask(words, inside.m), ref, hn::Set(words, kOutside)), words, refs + at);
  }

 private:
  // The ball round a far cell's centre; of other lanes a number nobody reads.
  HWY_INLINE void put_far(const Batch (&p)[3], const Word (&cell)[3], Word ref, Batch value, float* distance) const {
    const Words words;
    const Word level = hn::And(ref, hn::Set(words, 31u));
    const Word levels = hn::Set(words, static_cast<std::uint32_t>(tree_.levels));
    const Word shift = hn::Sub(levels, hn::Min(level, levels));
    const Batch count{
        hn::ConvertTo(FloatLanes(), hn::BitCast(Ints(), hn::Shl(hn::Set(words, 1u), hn::Min(level, levels))))};
    const Batch edge = Batch::broadcast(tree_.size) / count, half = Batch::broadcast(0.5f);
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

void find_all(const RegionTree& tree, vm::Points points, std::size_t count, std::uint32_t* refs, float* values,
              float* distance) {
  Descent descent(tree);
  for (std::size_t at = 0; at < count; at += kLanes) descent.run(points, at, refs, values, distance);
}

}  // namespace fathom::runtime::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace fathom::runtime {

HWY_EXPORT(find_all);

void find_regions(const RegionTree& tree, vm::Points points, std::size_t count, std::uint32_t* refs, float* values,
                  float* distance) {
  HWY_DYNAMIC_DISPATCH(find_all)(tree, points, count, refs, values, distance);
}

}  // namespace fathom::runtime
#endif  // HWY_ONCE
