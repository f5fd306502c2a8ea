// Elementary functions of FloatInterval: the f32 kernels at the ends, widened by twice a kernel's maximum error,
// because the kernels of monotone functions are not exactly monotone themselves. A jump inside the operand gives the
// hull of both sides. If a function is undefined somewhere in the operand, or the operand may be NaN, the result is
// the whole line.
#if defined(FATHOM_VM_FLOAT_INTERVAL_ELEMENTARY_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef FATHOM_VM_FLOAT_INTERVAL_ELEMENTARY_INL
#undef FATHOM_VM_FLOAT_INTERVAL_ELEMENTARY_INL
#else
#define FATHOM_VM_FLOAT_INTERVAL_ELEMENTARY_INL
#endif

#include "vm/number/elementary-inl.h"
#include "vm/number/float_interval-inl.h"

HWY_BEFORE_NAMESPACE();
namespace fathom::vm::HWY_NAMESPACE {

// Twice the 4 ulp of vm/number/elementary-inl.h: relative for normal numbers, absolute for subnormal ones. (On twelve
// million pairs of neighbouring floats every kernel was monotone.)
inline constexpr float kKernelShare = 0x1p-20f, kKernelLeast = 0x1p-146f;
inline constexpr float kAngleKnown = 1e4f;  // up to here the f32 kernels keep their error bound

// Returns [lo, hi] widened by the kernels' error. An overflowed bound stands for a finite value beyond the largest
// float.
HWY_INLINE FloatInterval kernel_range(Batch lo, Batch hi) {
  const Batch share = Batch::broadcast(kKernelShare), least = Batch::broadcast(kKernelLeast);
  const Batch low = min(lo, largest()), high = max(hi, -largest());
  return {low - (abs(low) * share + least), high + (abs(high) * share + least)};
}
HWY_INLINE FloatInterval clamp(const FloatInterval& a, float lo, float hi) {
  const Batch least = Batch::broadcast(lo), most = Batch::broadcast(hi);
  return {max(least, min(most, a.lo)), max(least, min(most, a.hi))};
}
HWY_INLINE FloatInterval whole_if_whole(const FloatInterval& a, const FloatInterval& value) {
  return whole_where(is_whole(a), value);
}
HWY_INLINE FloatInterval whole_if_whole(const FloatInterval& a, const FloatInterval& b, const FloatInterval& value) {
  return whole_where(is_whole(a) | is_whole(b), value);
}

// True if `a` contains, or may contain, an integer number of periods plus `offset` periods. `inverse` is 1 / period.
// Valid up to kAngleKnown.
HWY_INLINE BatchMask passes_multiple(const FloatInterval& a, double inverse, double offset) {
  const Batch scale = Batch::broadcast(inverse), shift = Batch::broadcast(offset);
  const Batch from = a.lo * scale, to = a.hi * scale;
  const Batch slack = (max(abs(from), abs(to)) + Batch::broadcast(1.0f)) * Batch::broadcast(0x1p-21f);
  return (from - shift) - slack <= floor((to - shift) + slack);
}
// Range of a sine wave that has a maximum at `offset` turns; `at_lo` and `at_hi` are its values at a's ends.
HWY_INLINE FloatInterval wave(const FloatInterval& a, Batch at_lo, Batch at_hi, double offset) {
  constexpr double kInverseTurn = 0.15915494309189535;
  const Batch one = Batch::broadcast(1.0f);
  const BatchMask known = magnitude(a) <= Batch::broadcast(kAngleKnown);
  const FloatInterval ends = clamp(kernel_range(min(at_lo, at_hi), max(at_lo, at_hi)), -1, 1);
  const BatchMask top = passes_multiple(a, kInverseTurn, offset) | (!known);
  const BatchMask bottom = passes_multiple(a, kInverseTurn, offset + 0.5) | (!known);
  return whole_where(!is_bounded(a), {select(bottom, -one, ends.lo), select(top, one, ends.hi)});
}
HWY_INLINE FloatInterval sin(const FloatInterval& a) { return wave(a, sin(a.lo), sin(a.hi), 0.25); }
HWY_INLINE FloatInterval cos(const FloatInterval& a) { return wave(a, cos(a.lo), cos(a.hi), 0); }
HWY_INLINE FloatInterval tan(const FloatInterval& a) {
  constexpr double kInverseHalfTurn = 0.3183098861837907;
  const BatchMask known = magnitude(a) <= Batch::broadcast(kAngleKnown);
  return whole_where((!known) | passes_multiple(a, kInverseHalfTurn, 0.5), kernel_range(tan(a.lo), tan(a.hi)));
}
HWY_INLINE FloatInterval asin(const FloatInterval& a) {
  return whole_if_whole(a, kernel_range(asin(a.lo), asin(a.hi)));
}
HWY_INLINE FloatInterval acos(const FloatInterval& a) {
  return whole_if_whole(a, kernel_range(acos(a.hi), acos(a.lo)));
}
HWY_INLINE FloatInterval atan(const FloatInterval& a) {
  return whole_if_whole(a, kernel_range(atan(a.lo), atan(a.hi)));
}
// Over a box that touches neither the origin nor the branch cut (y = 0, x <= 0), the extremes are at corners.
HWY_INLINE FloatInterval atan2(const FloatInterval& y, const FloatInterval& x) {
  const Batch zero = Batch::broadcast(0.0f), pi = Batch::broadcast(Precision<Batch>::kPi[0]);
  const Batch p = atan2(y.lo, x.lo), q = atan2(y.lo, x.hi), r = atan2(y.hi, x.lo), s = atan2(y.hi, x.hi);
  const BatchMask cut = (x.lo <= zero) & contains(y, zero);
  const Batch lo = min(min(p, q), min(r, s)), hi = max(max(p, q), max(r, s));
  return whole_if_whole(x, y, kernel_range(select(cut, -pi, lo), select(cut, pi, hi)));
}
HWY_INLINE FloatInterval exp(const FloatInterval& a) {
  const FloatInterval range = kernel_range(exp(a.lo), exp(a.hi));
  return whole_if_whole(a, {max(Batch::broadcast(0.0f), range.lo), range.hi});
}
HWY_INLINE FloatInterval log(const FloatInterval& a) {
  return whole_where(a.lo < Batch::broadcast(0.0f), kernel_range(log(a.lo), log(a.hi)));
}

HWY_INLINE FloatInterval sign(const FloatInterval& a) { return whole_if_whole(a, {sign(a.lo), sign(a.hi)}); }
HWY_INLINE FloatInterval logical_not(const FloatInterval& a) {
  const Batch zero = Batch::broadcast(0.0f), one = Batch::broadcast(1.0f);
  const BatchMask always = (a.lo == zero) & (a.hi == zero);
  return whole_if_whole(a, {select(always, one, zero), select(contains(a, zero), one, zero)});
}
// Returns a mask: maybe_true if a can be nonzero, maybe_false if a can be 0.
HWY_INLINE FloatIntervalMask is_true(const FloatInterval& a) {
  const Batch zero = Batch::broadcast(0.0f);
  return {(a.lo < zero) | (zero < a.hi), contains(a, zero)};
}
HWY_INLINE FloatInterval logical_and(const FloatInterval& a, const FloatInterval& b) {
  return whole_if_whole(a, select(is_true(a), b, as_enclosure(Batch::broadcast(0.0f))));
}
HWY_INLINE FloatInterval logical_or(const FloatInterval& a, const FloatInterval& b) {
  return whole_if_whole(a, select(is_true(a), a, b));
}
HWY_INLINE FloatInterval compare(const FloatInterval& a, const FloatInterval& b) {
  return whole_if_whole(a, b, {compare(a.lo, b.hi), compare(a.hi, b.lo)});
}
HWY_INLINE FloatInterval step(const FloatInterval& edge, const FloatInterval& x) {
  return whole_if_whole(edge, x, {step(edge.hi, x.lo), step(edge.lo, x.hi)});
}

// The result is within one period, except for the rounding of the quotient and the product. If the quotient or the
// product may overflow, the result is the whole line.
HWY_INLINE FloatInterval mod(const FloatInterval& a, const FloatInterval& b) {
  const Batch zero = Batch::broadcast(0.0f);
  const FloatInterval turns = floor(a / b);
  const Batch size = magnitude(sizes(a)) + magnitude(sizes(b));
  const Batch slack = size * Batch::broadcast(0x1p-21f) + Batch::broadcast(0x1p-146f);
  const FloatInterval period{min(zero, b.lo) - slack, max(zero, b.hi) + slack};
  const FloatInterval value = select(turns.lo == turns.hi, a - b * turns, period);
  return whole_where(!(is_bounded(turns) & (size < Batch::broadcast(0x1p126f))), value);
}

// Range of x^y for x >= 0, computed as in the kernel: exp(y log x).
HWY_INLINE FloatInterval positive_power(const FloatInterval& x, const FloatInterval& y) {
  const Batch zero = Batch::broadcast(0.0f), one = Batch::broadcast(1.0f), least = Batch::broadcast(0x1p-149f);
  const auto at_zero = [&](Batch exponent) HWY_ATTR {
    return select(zero < exponent, zero, select(exponent < zero, infinity(), one));
  };
  const FloatInterval positive = exp(y * log(FloatInterval{max(x.lo, least), max(x.hi, least)}));
  return select(zero < x.lo, positive, hull(positive, {at_zero(y.hi), at_zero(y.lo)}));
}
// A negative x has a power only for an integer exponent.
HWY_INLINE FloatInterval pow(const FloatInterval& x, const FloatInterval& y) {
  const Batch zero = Batch::broadcast(0.0f);
  const FloatInterval above = positive_power({max(zero, x.lo), max(zero, x.hi)}, y);
  const BatchMask negative = x.lo < zero;
  if (!any(negative)) return whole_if_whole(x, y, above);
  const FloatInterval size = positive_power({max(zero, -x.hi), max(zero, -x.lo)}, y);
  const Batch half = y.lo * Batch::broadcast(0.5f);
  const BatchMask whole = (y.lo == y.hi) & (floor(y.lo) == y.lo), odd = floor(half) < half;
  const FloatInterval below = select(odd, -size, size);
  const FloatInterval value = select(negative, select(x.hi < zero, below, hull(below, above)), above);
  return whole_where(is_whole(x) | is_whole(y) | (negative & !whole), value);
}

}  // namespace fathom::vm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
