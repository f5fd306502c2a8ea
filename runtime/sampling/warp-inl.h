// The functions of warp.h and their sines, in lanes: bit for bit the same.
// Tested by: tests/runtime/path/scatter_lanes_test.cpp
#if defined(FATHOM_RUNTIME_WARP_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef FATHOM_RUNTIME_WARP_INL
#undef FATHOM_RUNTIME_WARP_INL
#else
#define FATHOM_RUNTIME_WARP_INL
#endif

#include "vm/number/batch-inl.h"

HWY_BEFORE_NAMESPACE();
namespace fathom::runtime::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Floats = vm::HWY_NAMESPACE::Batch;
using Vectors = vm::HWY_NAMESPACE::Vec3<Floats>;

constexpr float kInversePi = 0.318309886183790672f;

HWY_INLINE Floats number(float value) { return Floats::broadcast(value); }
HWY_INLINE Vectors operator+(Vectors a, Vectors b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
HWY_INLINE Vectors operator*(Vectors a, Floats s) { return {a.x * s, a.y * s, a.z * s}; }
HWY_INLINE Floats dot(Vectors a, Vectors b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

struct SinesAndCosines {
  Floats sin, cos;
};

// As sincos_turn() of runtime/base/elementary.h.
HWY_INLINE SinesAndCosines sincos_turn(Floats u) {
  const hn::ScalableTag<float> floats;
  const hn::RebindToSigned<decltype(floats)> ints;
  const Floats quarters = number(4) * u;
  const auto quadrant = hn::ConvertTo(ints, (quarters + number(0.5f)).v);
  const Floats x = (quarters - Floats{hn::ConvertTo(floats, quadrant)}) * number(1.57079632679489662f);
  const Floats z = x * x;
  const Floats s =
      ((number(-1.9515295891e-4f) * z + number(8.3321608736e-3f)) * z - number(1.6666654611e-1f)) * z * x + x;
  const Floats c =
      ((number(2.443315711809948e-5f) * z - number(1.388731625493765e-3f)) * z + number(4.166664568298827e-2f)) * z *
          z -
      number(0.5f) * z + number(1);
  const auto one = hn::Set(ints, 1), two = hn::Set(ints, 2);
  const auto swaps = hn::MaskFromVec(hn::BitCast(floats, hn::Neg(hn::And(quadrant, one))));
  const auto sign = [&](auto bits) HWY_ATTR { return hn::BitCast(floats, hn::ShiftLeft<30>(hn::And(bits, two))); };
  return {{hn::Xor(hn::IfThenElse(swaps, c.v, s.v), sign(quadrant))},
          {hn::Xor(hn::IfThenElse(swaps, s.v, c.v), sign(hn::Add(quadrant, one)))}};
}

HWY_INLINE Vectors square_to_cosine_hemisphere(Floats u, Floats v) {
  const Floats radius = sqrt(u);
  const SinesAndCosines angle = sincos_turn(v);
  return {radius * angle.cos, radius * angle.sin, sqrt(number(1) - u)};
}

HWY_INLINE Vectors to_frame(Vectors n, Vectors local) {
  const Floats one = number(1), sign = {hn::CopySign(one.v, n.z.v)};
  const Floats a = number(-1) / (sign + n.z), b = n.x * n.y * a;
  const Vectors x = {one + sign * n.x * n.x * a, sign * b, -sign * n.x};
  const Vectors y = {b, sign + n.y * n.y * a, -n.y};
  return x * local.x + y * local.y + n * local.z;
}

}  // namespace fathom::runtime::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
