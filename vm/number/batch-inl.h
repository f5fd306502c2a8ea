// Batch and RealBatch: one register of f32 or double lanes of the instruction set. Multiplies and adds are never
// fused, so that every instruction set gives the same bits.
#if defined(FATHOM_VM_BATCH_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef FATHOM_VM_BATCH_INL
#undef FATHOM_VM_BATCH_INL
#else
#define FATHOM_VM_BATCH_INL
#endif

#include <cstddef>
#include <cstdint>

#include "vm/number/number-inl.h"

HWY_BEFORE_NAMESPACE();
namespace fathom::vm::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class S>
struct BatchMaskOf {
  hn::Mask<hn::ScalableTag<S>> m;
};

// Register of lanes of type S, float or double.
template <class S>
struct BatchOf {
  using Constant = BatchOf;
  using Tag = hn::ScalableTag<S>;
  hn::Vec<Tag> v;

  static HWY_INLINE BatchOf broadcast(float value) { return {hn::Set(Tag(), static_cast<S>(value))}; }
  static HWY_INLINE BatchOf broadcast(double value) { return {hn::Set(Tag(), static_cast<S>(value))}; }
  static HWY_INLINE BatchOf load(const S* from) { return {hn::LoadU(Tag(), from)}; }
  HWY_INLINE void store(S* to) const { hn::StoreU(v, Tag(), to); }
};
template <class S>
inline constexpr std::size_t kLanesOf = hn::MaxLanes(hn::ScalableTag<S>());

using FloatLanes = hn::ScalableTag<float>;
using Batch = BatchOf<float>;
using BatchMask = BatchMaskOf<float>;
using RealBatch = BatchOf<double>;
inline constexpr std::size_t kLanes = kLanesOf<float>;

template <class S>
HWY_INLINE BatchOf<S> operator+(BatchOf<S> a, BatchOf<S> b) {
  return {hn::Add(a.v, b.v)};
}
template <class S>
HWY_INLINE BatchOf<S> operator-(BatchOf<S> a, BatchOf<S> b) {
  return {hn::Sub(a.v, b.v)};
}
template <class S>
HWY_INLINE BatchOf<S> operator*(BatchOf<S> a, BatchOf<S> b) {
  return {hn::Mul(a.v, b.v)};
}
template <class S>
HWY_INLINE BatchOf<S> operator/(BatchOf<S> a, BatchOf<S> b) {
  return {hn::Div(a.v, b.v)};
}
template <class S>
HWY_INLINE BatchOf<S> operator-(BatchOf<S> a) {
  return {hn::Neg(a.v)};
}
template <class S>
HWY_INLINE BatchMaskOf<S> operator<(BatchOf<S> a, BatchOf<S> b) {
  return {hn::Lt(a.v, b.v)};
}
template <class S>
HWY_INLINE BatchMaskOf<S> operator>(BatchOf<S> a, BatchOf<S> b) {
  return {hn::Lt(b.v, a.v)};
}
template <class S>
HWY_INLINE BatchMaskOf<S> operator<=(BatchOf<S> a, BatchOf<S> b) {
  return {hn::Le(a.v, b.v)};
}
template <class S>
HWY_INLINE BatchMaskOf<S> operator>=(BatchOf<S> a, BatchOf<S> b) {
  return {hn::Le(b.v, a.v)};
}
template <class S>
HWY_INLINE BatchMaskOf<S> operator==(BatchOf<S> a, BatchOf<S> b) {
  return {hn::Eq(a.v, b.v)};
}
template <class S>
HWY_INLINE BatchMaskOf<S> operator&(BatchMaskOf<S> a, BatchMaskOf<S> b) {
  return {hn::And(a.m, b.m)};
}
template <class S>
HWY_INLINE BatchMaskOf<S> operator|(BatchMaskOf<S> a, BatchMaskOf<S> b) {
  return {hn::Or(a.m, b.m)};
}
template <class S>
HWY_INLINE BatchMaskOf<S> operator!(BatchMaskOf<S> a) {
  return {hn::Not(a.m)};
}
template <class S>
HWY_INLINE bool any(BatchMaskOf<S> a) {
  return !hn::AllFalse(hn::ScalableTag<S>(), a.m);
}
template <class S>
HWY_INLINE BatchOf<S> select(BatchMaskOf<S> m, BatchOf<S> yes, BatchOf<S> no) {
  return {hn::IfThenElse(m.m, yes.v, no.v)};
}
// min(a, b) is a < b ? a : b, so a NaN in either operand gives b. x86's minps and minpd follow this rule; other
// instruction sets and Highway's emulation follow others.
#undef FATHOM_X86_REGISTERS
#define FATHOM_X86_REGISTERS (HWY_TARGET == HWY_SSE4 || HWY_TARGET == HWY_AVX2 || HWY_TARGET == HWY_AVX3)
template <class S>
HWY_INLINE BatchOf<S> min(BatchOf<S> a, BatchOf<S> b) {
#if FATHOM_X86_REGISTERS
  return {hn::Min(a.v, b.v)};
#else
  return select(a < b, a, b);
#endif
}
template <class S>
HWY_INLINE BatchOf<S> max(BatchOf<S> a, BatchOf<S> b) {
#if FATHOM_X86_REGISTERS
  return {hn::Max(a.v, b.v)};
#else
  return select(a > b, a, b);
#endif
}
template <class S>
HWY_INLINE BatchOf<S> abs(BatchOf<S> a) {
  return {hn::Abs(a.v)};
}
template <class S>
HWY_INLINE BatchOf<S> sqr(BatchOf<S> a) {
  return a * a;
}
template <class S>
HWY_INLINE BatchOf<S> sqrt(BatchOf<S> a) {
  return {hn::Sqrt(a.v)};
}
template <class S>
HWY_INLINE BatchOf<S> length(BatchOf<S> x, BatchOf<S> y) {
  return sqrt(x * x + y * y);
}
template <class S>
HWY_INLINE BatchOf<S> length(BatchOf<S> x, BatchOf<S> y, BatchOf<S> z) {
  return sqrt(x * x + y * y + z * z);
}

// Rounding functions. Adding 0 turns -0 into 0, because instruction sets differ in the sign of a rounded zero.
template <class S>
HWY_INLINE BatchOf<S> floor(BatchOf<S> a) {
  return BatchOf<S>{hn::Floor(a.v)} + BatchOf<S>::broadcast(0.0);
}
template <class S>
HWY_INLINE BatchOf<S> ceil(BatchOf<S> a) {
  return BatchOf<S>{hn::Ceil(a.v)} + BatchOf<S>::broadcast(0.0);
}
template <class S>
HWY_INLINE BatchOf<S> round_nearest(BatchOf<S> a) {  // half to even
  return BatchOf<S>{hn::Round(a.v)} + BatchOf<S>::broadcast(0.0);
}
template <class S>
HWY_INLINE BatchMaskOf<S> is_nan(BatchOf<S> a) {
  return {hn::IsNaN(a.v)};
}

// Bit layout of a floating-point type.
template <class S>
struct FloatLayout;
template <>
struct FloatLayout<float> {
  static constexpr int kMantissaBits = 23, kBias = 127, kSubnormalShift = 24;
  static constexpr float kMinNormal = 0x1p-126f, kShift = 0x1p24f;
  static constexpr std::int32_t kRootHalf = 0x3f3504f3;  // sqrt 1/2
};
template <>
struct FloatLayout<double> {
  static constexpr int kMantissaBits = 52, kBias = 1023, kSubnormalShift = 54;
  static constexpr double kMinNormal = 0x1p-1022, kShift = 0x1p54;
  static constexpr std::int64_t kRootHalf = 0x3fe6a09e667f3bcd;
};

// Returns 2^n for an integer n in [1 - bias, bias], and any number for NaN.
template <class S>
HWY_INLINE BatchOf<S> power_of_two(BatchOf<S> n) {
  using Layout = FloatLayout<S>;
  const hn::RebindToSigned<hn::ScalableTag<S>> ints;
  // Vectors convert NaN to some number. In portable code, as in C++, the conversion is undefined.
  const auto defined = HWY_TARGET == HWY_SCALAR ? hn::IfThenElseZero(hn::Eq(n.v, n.v), n.v) : n.v;
  const auto biased = hn::Add(hn::ConvertTo(ints, defined), hn::Set(ints, Layout::kBias));
  return {hn::BitCast(hn::ScalableTag<S>(), hn::ShiftLeft<Layout::kMantissaBits>(biased))};
}
template <class S>
HWY_INLINE Scaled<BatchOf<S>> split_power_of_two(BatchOf<S> x) {
  using Layout = FloatLayout<S>;
  using B = BatchOf<S>;
  const hn::ScalableTag<S> tag;
  const hn::RebindToSigned<hn::ScalableTag<S>> ints;
  const auto subnormal = x < B::broadcast(Layout::kMinNormal);
  const B normal = select(subnormal, x * B::broadcast(Layout::kShift), x);
  const auto bits = hn::BitCast(ints, normal.v);
  const auto exponent = hn::ShiftRight<Layout::kMantissaBits>(hn::Sub(bits, hn::Set(ints, Layout::kRootHalf)));
  const B e{hn::ConvertTo(tag, exponent)};
  return {{hn::BitCast(tag, hn::Sub(bits, hn::ShiftLeft<Layout::kMantissaBits>(exponent)))},
          select(subnormal, e - B::broadcast(static_cast<double>(Layout::kSubnormalShift)), e)};
}

}  // namespace fathom::vm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
