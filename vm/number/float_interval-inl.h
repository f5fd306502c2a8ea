// FloatInterval: the range of f32 results while the point ranges over a box of f32 points; one box per lane.
//
// A FloatInterval bounds f32 results, not exact ones. Rounding preserves the order of two numbers, so if an
// operation is monotone in each operand, the f32 results at the ends are the ends of all f32 results, without outward
// rounding. The whole line [-inf, inf] means "any value, or NaN", and every value that may be NaN has the whole line.
// So an infinite end is a value that floats can reach, and 0 times an infinite end is NaN. An undecided comparison
// gives the hull of both answers. No bound is NaN, and -0 counts as 0. Constants are those of f32 evaluation, and
// finite. The elementary functions are in float_interval_elementary-inl.h. Source: Moore, "Interval Analysis", 1966.
//
//     x * x - 1 over x in [-1, 2] as a product:    [-2, 4] - 1 = [-3, 3]      with sqr:    [0, 4] - 1 = [-1, 3]
//
// Tested by: tests/vm/range/enclosure_test.cpp
#if defined(FATHOM_VM_FLOAT_INTERVAL_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef FATHOM_VM_FLOAT_INTERVAL_INL
#undef FATHOM_VM_FLOAT_INTERVAL_INL
#else
#define FATHOM_VM_FLOAT_INTERVAL_INL
#endif

#include <limits>

#include "vm/number/batch-inl.h"

HWY_BEFORE_NAMESPACE();
namespace fathom::vm::HWY_NAMESPACE {

struct FloatInterval {
  using Constant = Batch;
  Batch lo, hi;
};

// Result of a comparison over a box: the comparison can hold somewhere, fail somewhere, or both.
struct FloatIntervalMask {
  BatchMask maybe_true, maybe_false;
};

HWY_INLINE Batch infinity() { return Batch::broadcast(std::numeric_limits<float>::infinity()); }
HWY_INLINE Batch largest() { return Batch::broadcast(std::numeric_limits<float>::max()); }

HWY_INLINE BatchMask is_whole(const FloatInterval& a) { return (a.lo == -infinity()) & (a.hi == infinity()); }
HWY_INLINE BatchMask is_bounded(const FloatInterval& a) { return (-infinity() < a.lo) & (a.hi < infinity()); }
HWY_INLINE BatchMask contains(const FloatInterval& a, Batch x) { return (a.lo <= x) & (x <= a.hi); }
HWY_INLINE Batch magnitude(const FloatInterval& a) { return max(-a.lo, a.hi); }

HWY_INLINE FloatInterval whole_where(BatchMask mask, const FloatInterval& a) {
  return {select(mask, -infinity(), a.lo), select(mask, infinity(), a.hi)};
}
// Replaces a NaN bound, the result of cancelling infinities, by an infinite one: min and max return their second
// operand if the first is NaN.
HWY_INLINE FloatInterval without_nan(Batch lo, Batch hi) { return {max(lo, -infinity()), min(hi, infinity())}; }
HWY_INLINE FloatInterval hull(const FloatInterval& a, const FloatInterval& b) {
  return {min(a.lo, b.lo), max(a.hi, b.hi)};
}
HWY_INLINE FloatInterval as_enclosure(const FloatInterval& a) { return a; }
HWY_INLINE FloatInterval as_enclosure(Batch a) { return {a, a}; }
HWY_INLINE FloatInterval as_value(const FloatInterval&, Batch k) { return {k, k}; }

HWY_INLINE FloatInterval operator-(const FloatInterval& a) { return {-a.hi, -a.lo}; }
HWY_INLINE FloatInterval operator+(const FloatInterval& a, const FloatInterval& b) {
  return without_nan(a.lo + b.lo, a.hi + b.hi);
}
HWY_INLINE FloatInterval operator-(const FloatInterval& a, const FloatInterval& b) {
  return without_nan(a.lo - b.hi, a.hi - b.lo);
}
HWY_INLINE FloatInterval operator+(const FloatInterval& a, Batch b) { return {a.lo + b, a.hi + b}; }
HWY_INLINE FloatInterval operator+(Batch a, const FloatInterval& b) { return {a + b.lo, a + b.hi}; }
HWY_INLINE FloatInterval operator-(const FloatInterval& a, Batch b) { return {a.lo - b, a.hi - b}; }
HWY_INLINE FloatInterval operator-(Batch a, const FloatInterval& b) { return {a - b.hi, a - b.lo}; }

// The sum of the products is NaN if one of the products is NaN, or if they already span the whole line.
HWY_INLINE FloatInterval operator*(const FloatInterval& a, const FloatInterval& b) {
  const Batch p = a.lo * b.lo, q = a.lo * b.hi, r = a.hi * b.lo, s = a.hi * b.hi;
  return whole_where(is_nan((p + q) + (r + s)), {min(min(p, q), min(r, s)), max(max(p, q), max(r, s))});
}
HWY_INLINE FloatInterval operator*(const FloatInterval& a, Batch b) {
  const Batch p = a.lo * b, q = a.hi * b;
  return whole_where(is_nan(p + q), {min(p, q), max(p, q)});
}
HWY_INLINE FloatInterval operator*(Batch a, const FloatInterval& b) { return b * a; }

// Divides by a divisor of constant sign, made positive first. A divisor that contains 0 gives the whole line.
HWY_INLINE FloatInterval operator/(const FloatInterval& a, const FloatInterval& b) {
  const Batch zero = Batch::broadcast(0.0f);
  const BatchMask negative = b.hi < zero;
  const FloatInterval n{select(negative, -a.hi, a.lo), select(negative, -a.lo, a.hi)};
  const FloatInterval d{select(negative, -b.hi, b.lo), select(negative, -b.lo, b.hi)};
  const Batch lo = n.lo / select(n.lo < zero, d.lo, d.hi), hi = n.hi / select(n.hi < zero, d.hi, d.lo);
  const BatchMask both_infinite = (magnitude(a) == infinity()) & (magnitude(b) == infinity());
  return whole_where(contains(b, zero) | both_infinite, {lo, hi});
}
HWY_INLINE FloatInterval operator/(const FloatInterval& a, Batch b) { return a / as_enclosure(b); }
HWY_INLINE FloatInterval operator/(Batch a, const FloatInterval& b) { return as_enclosure(a) / b; }

HWY_INLINE FloatIntervalMask operator<(const FloatInterval& a, const FloatInterval& b) {
  return {a.lo < b.hi, a.hi >= b.lo};
}
HWY_INLINE FloatIntervalMask operator<(const FloatInterval& a, Batch b) { return {a.lo < b, a.hi >= b}; }
HWY_INLINE FloatIntervalMask operator<(Batch a, const FloatInterval& b) { return {a < b.hi, a >= b.lo}; }
HWY_INLINE FloatIntervalMask operator>(const FloatInterval& a, const FloatInterval& b) { return b < a; }
HWY_INLINE FloatIntervalMask operator>(const FloatInterval& a, Batch b) { return b < a; }
HWY_INLINE FloatIntervalMask operator>(Batch a, const FloatInterval& b) { return b < a; }
HWY_INLINE bool any(const FloatIntervalMask& mask) { return any(mask.maybe_true); }
HWY_INLINE FloatInterval select(const FloatIntervalMask& mask, const FloatInterval& yes, const FloatInterval& no) {
  return {min(select(mask.maybe_true, yes.lo, no.lo), select(mask.maybe_false, no.lo, yes.lo)),
          max(select(mask.maybe_true, yes.hi, no.hi), select(mask.maybe_false, no.hi, yes.hi))};
}
HWY_INLINE FloatInterval select(const FloatIntervalMask& mask, Batch yes, Batch no) {
  return select(mask, as_enclosure(yes), as_enclosure(no));
}
HWY_INLINE FloatInterval select(BatchMask mask, const FloatInterval& yes, const FloatInterval& no) {
  return {select(mask, yes.lo, no.lo), select(mask, yes.hi, no.hi)};
}

// min and max return b if an operand is NaN. So if a may be NaN, the result may be any value of b, which the bounds
// include; if b may be NaN, the result may be NaN.
HWY_INLINE FloatInterval min(const FloatInterval& a, const FloatInterval& b) {
  return {min(a.lo, b.lo), select(is_whole(b), infinity(), min(a.hi, b.hi))};
}
HWY_INLINE FloatInterval max(const FloatInterval& a, const FloatInterval& b) {
  return {select(is_whole(b), -infinity(), max(a.lo, b.lo)), max(a.hi, b.hi)};
}
HWY_INLINE FloatInterval min(const FloatInterval& a, Batch b) { return {min(a.lo, b), min(a.hi, b)}; }
HWY_INLINE FloatInterval max(const FloatInterval& a, Batch b) { return {max(a.lo, b), max(a.hi, b)}; }
HWY_INLINE FloatInterval min(Batch a, const FloatInterval& b) { return min(as_enclosure(a), b); }
HWY_INLINE FloatInterval max(Batch a, const FloatInterval& b) { return max(as_enclosure(a), b); }

// Range of |a|; not valid where a is the whole line, because a may be NaN there.
HWY_INLINE FloatInterval sizes(const FloatInterval& a) {
  return {max(Batch::broadcast(0.0f), max(a.lo, -a.hi)), magnitude(a)};
}
HWY_INLINE FloatInterval squares(const FloatInterval& a) {
  const FloatInterval m = sizes(a);
  return {m.lo * m.lo, m.hi * m.hi};
}
HWY_INLINE FloatInterval abs(const FloatInterval& a) { return whole_where(is_whole(a), sizes(a)); }
HWY_INLINE FloatInterval sqr(const FloatInterval& a) { return whole_where(is_whole(a), squares(a)); }
HWY_INLINE FloatInterval sqrt(const FloatInterval& a) {
  return whole_where(a.lo < Batch::broadcast(0.0f), {sqrt(a.lo), sqrt(a.hi)});
}
HWY_INLINE FloatInterval length(const FloatInterval& x, const FloatInterval& y) {
  const FloatInterval a = squares(x), b = squares(y);
  return whole_where(is_whole(x) | is_whole(y), {sqrt(a.lo + b.lo), sqrt(a.hi + b.hi)});
}
HWY_INLINE FloatInterval length(const FloatInterval& x, const FloatInterval& y, const FloatInterval& z) {
  const FloatInterval a = squares(x), b = squares(y), c = squares(z);
  return whole_where(is_whole(x) | is_whole(y) | is_whole(z), {sqrt(a.lo + b.lo + c.lo), sqrt(a.hi + b.hi + c.hi)});
}

HWY_INLINE FloatInterval floor(const FloatInterval& a) { return {floor(a.lo), floor(a.hi)}; }
HWY_INLINE FloatInterval ceil(const FloatInterval& a) { return {ceil(a.lo), ceil(a.hi)}; }
HWY_INLINE FloatInterval round_nearest(const FloatInterval& a) { return {round_nearest(a.lo), round_nearest(a.hi)}; }

}  // namespace fathom::vm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
