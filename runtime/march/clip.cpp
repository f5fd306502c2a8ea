// Compiled once for each instruction set and chosen at run time (Highway's foreach_target).
#include "runtime/march/clip.h"

#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "runtime/march/clip.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace fathom::runtime::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Doubles = hn::ScalableTag<double>;
using V = hn::Vec<Doubles>;
using Mask = hn::Mask<Doubles>;

HWY_INLINE V k(double value) { return hn::Set(Doubles(), value); }
template <class E>
HWY_INLINE V code(E value) {
  return k(static_cast<double>(value));
}
// Like std::min and std::max: if one operand is NaN, they return the first.
HWY_INLINE V first_min(V a, V b) { return hn::IfThenElse(hn::Lt(b, a), b, a); }
HWY_INLINE V first_max(V a, V b) { return hn::IfThenElse(hn::Lt(a, b), b, a); }
HWY_INLINE Mask finite(V a) { return hn::Lt(hn::Abs(a), k(std::numeric_limits<double>::infinity())); }

// Clips the rays from `i` on that a register holds.
HWY_INLINE void clip_register(RayBlock& rays, std::size_t i, const compiler::Box& box, double far) {
  const Doubles d;
  V origin[3], direction[3];
  for (int axis = 0; axis < 3; ++axis) {
    origin[axis] = hn::LoadU(d, rays.origin[axis] + i);
    direction[axis] = hn::LoadU(d, rays.direction[axis] + i);
  }
  const V length = hn::LoadU(d, rays.length + i);
  const V squared = hn::Add(hn::Add(hn::Mul(direction[0], direction[0]), hn::Mul(direction[1], direction[1])),
                            hn::Mul(direction[2], direction[2]));
  Mask valid = hn::And(hn::And(hn::Gt(squared, k(1e-60)), hn::Lt(squared, k(1e60))), hn::Eq(length, length));
  for (const V& coordinate : origin) valid = hn::And(valid, finite(coordinate));
  const Mask unit = hn::Lt(hn::Abs(hn::Sub(squared, k(1))), k(1e-6));
  if (!hn::AllTrue(d, unit)) {
    const V norm = hn::Sqrt(squared);
    for (V& component : direction) component = hn::IfThenElse(unit, component, hn::Div(component, norm));
  }

  V begin = hn::LoadU(d, rays.entry + i), end = first_min(length, k(far));
  Mask past = hn::Lt(k(box.empty() ? 0 : 1), k(1));
  for (int axis = 0; axis < 3; ++axis) {
    const V inverse = hn::Div(k(1), direction[axis]), lo = k(box.lo[axis]), hi = k(box.hi[axis]);
    const V a = hn::Mul(hn::Sub(lo, origin[axis]), inverse), b = hn::Mul(hn::Sub(hi, origin[axis]), inverse);
    const Mask along = hn::Eq(direction[axis], hn::Zero(d));  // the ray never meets the slab's planes
    begin = hn::IfThenElse(along, begin, first_max(begin, first_min(a, b)));
    end = hn::IfThenElse(along, end, first_min(end, first_max(a, b)));
    past = hn::Or(past, hn::AndNot(hn::And(hn::Ge(origin[axis], lo), hn::Le(origin[axis], hi)), along));
  }
  past = hn::Or(past, hn::Not(hn::Le(begin, end)));

  for (int axis = 0; axis < 3; ++axis) {
    hn::StoreU(hn::Add(origin[axis], hn::Mul(begin, direction[axis])), d, rays.origin[axis] + i);
    hn::StoreU(direction[axis], d, rays.direction[axis] + i);
  }
  hn::StoreU(hn::Sub(end, begin), d, rays.length + i);
  hn::StoreU(begin, d, rays.entry + i);
  const V result = hn::IfThenElse(past, code(ClipResult::Past), code(ClipResult::Within));
  hn::StoreU(hn::IfThenElse(valid, result, code(ClipResult::Invalid)), d, rays.result + i);
}

void clip_rays(RayBlock& rays, std::size_t first, const compiler::Box& box, double far) {
  for (std::size_t i = first; i < rays.count; i += hn::Lanes(Doubles())) clip_register(rays, i, box, far);
}

}  // namespace fathom::runtime::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace fathom::runtime {

HWY_EXPORT(clip_rays);

void clip(RayBlock& rays, std::size_t first, const compiler::Box& box, double far) {
  HWY_DYNAMIC_DISPATCH(clip_rays)(rays, first, box, far);
  for (std::size_t i = first; i < rays.count; ++i) {
    if (rays.entry[i] > 0 && rays.side[i] == 0) rays.side[i] = 1;
  }
}

}  // namespace fathom::runtime
#endif  // HWY_ONCE
