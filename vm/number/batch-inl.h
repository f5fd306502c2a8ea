// Batch: as many f32 lanes as the instruction set has in a register. Plain multiplies and adds only, never fused, so
// that every instruction set gives the same bits.
#if defined(FATHOM_VM_BATCH_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef FATHOM_VM_BATCH_INL
#undef FATHOM_VM_BATCH_INL
#else
#define FATHOM_VM_BATCH_INL
#endif

#include "vm/number/number-inl.h"

HWY_BEFORE_NAMESPACE();
namespace fathom::vm::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using FloatLanes = hn::ScalableTag<float>;
inline constexpr std::size_t kLanes = hn::MaxLanes(FloatLanes());

struct Batch {
  using Constant = Batch;
  hn::Vec<FloatLanes> v;

  static HWY_INLINE Batch broadcast(float value) { return {hn::Set(FloatLanes(), value)}; }
  static HWY_INLINE Batch broadcast(double value) { return broadcast(static_cast<float>(value)); }
  static HWY_INLINE Batch load(const float* from) { return {hn::LoadU(FloatLanes(), from)}; }
  HWY_INLINE void store(float* to) const { hn::StoreU(v, FloatLanes(), to); }
};

struct BatchMask {
  hn::Mask<FloatLanes> m;
};

HWY_INLINE Batch operator+(Batch a, Batch b) { return {hn::Add(a.v, b.v)}; }
HWY_INLINE Batch operator-(Batch a, Batch b) { return {hn::Sub(a.v, b.v)}; }
HWY_INLINE Batch operator*(Batch a, Batch b) { return {hn::Mul(a.v, b.v)}; }
HWY_INLINE Batch operator/(Batch a, Batch b) { return {hn::Div(a.v, b.v)}; }
HWY_INLINE Batch operator-(Batch a) { return {hn::Neg(a.v)}; }
HWY_INLINE BatchMask operator<(Batch a, Batch b) { return {hn::Lt(a.v, b.v)}; }
HWY_INLINE BatchMask operator>(Batch a, Batch b) { return {hn::Lt(b.v, a.v)}; }
HWY_INLINE BatchMask operator<=(Batch a, Batch b) { return {hn::Le(a.v, b.v)}; }
HWY_INLINE BatchMask operator>=(Batch a, Batch b) { return {hn::Le(b.v, a.v)}; }
HWY_INLINE BatchMask operator==(Batch a, Batch b) { return {hn::Eq(a.v, b.v)}; }
HWY_INLINE BatchMask operator&(BatchMask a, BatchMask b) { return {hn::And(a.m, b.m)}; }
HWY_INLINE BatchMask operator|(BatchMask a, BatchMask b) { return {hn::Or(a.m, b.m)}; }
HWY_INLINE BatchMask operator!(BatchMask a) { return {hn::Not(a.m)}; }
HWY_INLINE bool any(BatchMask a) { return !hn::AllFalse(FloatLanes(), a.m); }
HWY_INLINE Batch select(BatchMask m, Batch yes, Batch no) { return {hn::IfThenElse(m.m, yes.v, no.v)}; }
// a < b ? a : b, so that a NaN gives b. That is what x86's minps computes; other machines and Highway's emulation
// have other rules.
#undef FATHOM_X86_REGISTERS
#define FATHOM_X86_REGISTERS (HWY_TARGET == HWY_SSE4 || HWY_TARGET == HWY_AVX2 || HWY_TARGET == HWY_AVX3)
HWY_INLINE Batch min(Batch a, Batch b) {
#if FATHOM_X86_REGISTERS
  return {hn::Min(a.v, b.v)};
#else
  return select(a < b, a, b);
#endif
}
HWY_INLINE Batch max(Batch a, Batch b) {
#if FATHOM_X86_REGISTERS
  return {hn::Max(a.v, b.v)};
#else
  return select(a > b, a, b);
#endif
}
HWY_INLINE Batch abs(Batch a) { return {hn::Abs(a.v)}; }
HWY_INLINE Batch sqr(Batch a) { return a * a; }
HWY_INLINE Batch sqrt(Batch a) { return {hn::Sqrt(a.v)}; }
HWY_INLINE Batch length(Batch x, Batch y) { return sqrt(x * x + y * y); }
HWY_INLINE Batch length(Batch x, Batch y, Batch z) { return sqrt(x * x + y * y + z * z); }

// Adding 0 makes -0 into 0: instruction sets differ in the sign of a zero they round to.
HWY_INLINE Batch floor(Batch a) { return Batch{hn::Floor(a.v)} + Batch::broadcast(0.0f); }
HWY_INLINE Batch ceil(Batch a) { return Batch{hn::Ceil(a.v)} + Batch::broadcast(0.0f); }
HWY_INLINE Batch round_nearest(Batch a) { return Batch{hn::Round(a.v)} + Batch::broadcast(0.0f); }  // half to even
HWY_INLINE BatchMask is_nan(Batch a) { return {hn::IsNaN(a.v)}; }

// 2^n for a whole n in [-126, 127].
HWY_INLINE Batch power_of_two(Batch n) {
  const hn::RebindToSigned<FloatLanes> ints;
  const auto biased = hn::Add(hn::ConvertTo(ints, n.v), hn::Set(ints, 127));
  return {hn::BitCast(FloatLanes(), hn::ShiftLeft<23>(biased))};
}
HWY_INLINE Scaled<Batch> split_power_of_two(Batch x) {
  const hn::RebindToSigned<FloatLanes> ints;
  const BatchMask subnormal = x < Batch::broadcast(0x1p-126f);
  const Batch normal = select(subnormal, x * Batch::broadcast(0x1p24f), x);
  const auto bits = hn::BitCast(ints, normal.v);
  const auto exponent = hn::ShiftRight<23>(hn::Sub(bits, hn::Set(ints, 0x3f3504f3)));
  const Batch e{hn::ConvertTo(FloatLanes(), exponent)};
  return {{hn::BitCast(FloatLanes(), hn::Sub(bits, hn::ShiftLeft<23>(exponent)))},
          select(subnormal, e - Batch::broadcast(24.0f), e)};
}

}  // namespace fathom::vm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
