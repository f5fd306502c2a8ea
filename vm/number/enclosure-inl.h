// Enclosure: the range of f32 results while the point ranges over a box of f32 points; one box per lane.
//
// An Enclosure bounds f32 results, not exact ones. Rounding preserves the order of two numbers, so if an operation is
// monotone in each operand, the f32 results at the ends are the ends of all f32 results, without outward rounding.
// The whole line [-inf, inf] means "any value, or NaN", and every value that may be NaN has the whole line. So an
// infinite end is a value that floats can reach, and 0 times an infinite end is NaN. An undecided comparison gives
// the hull of both answers. No bound is NaN, and -0 counts as 0. Constants are those of f32 evaluation, and finite.
// The elementary functions are in enclosure_elementary-inl.h. Source: Moore, "Interval Analysis", 1966.
//
//     x * x - 1 over x in [-1, 2] as a product:    [-2, 4] - 1 = [-3, 3]      with sqr:    [0, 4] - 1 = [-1, 3]
//
// Tested by: tests/vm/range/enclosure_test.cpp
#if defined(FATHOM_VM_ENCLOSURE_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef FATHOM_VM_ENCLOSURE_INL
#undef FATHOM_VM_ENCLOSURE_INL
#else
#define FATHOM_VM_ENCLOSURE_INL
#endif

#include <limits>

#include "vm/number/batch-inl.h"

HWY_BEFORE_NAMESPACE();
namespace fathom::vm::HWY_NAMESPACE {

struct Enclosure {
  using Constant = Batch;
  Batch lo, hi;
};

// Result of a comparison over a box: the comparison can hold somewhere, fail somewhere, or both.
struct EnclosureMask {
  BatchMask maybe_true, maybe_false;
};

HWY_INLINE Batch infinity() { return Batch::broadcast(std::numeric_limits<float>::infinity()); }
HWY_INLINE Batch largest() { return Batch::broadcast(std::numeric_limits<float>::max()); }

HWY_INLINE BatchMask is_whole(const Enclosure& a) { return (a.lo == -infinity()) & (a.hi == infinity()); }
HWY_INLINE BatchMask is_bounded(const Enclosure& a) { return (-infinity() < a.lo) & (a.hi < infinity()); }
HWY_INLINE BatchMask contains(const Enclosure& a, Batch x) { return (a.lo <= x) & (x <= a.hi); }
HWY_INLINE Batch magnitude(const Enclosure& a) { return max(-a.lo, a.hi); }

HWY_INLINE Enclosure whole_where(BatchMask mask, const Enclosure& a) {
  return {select(mask, -infinity(), a.lo), select(mask, infinity(), a.hi)};
}
// Replaces a NaN bound, the result of cancelling infinities, by an infinite one: min and max return their second
// operand if the first is NaN.
HWY_INLINE Enclosure without_nan(Batch lo, Batch hi) { return {max(lo, -infinity()), min(hi, infinity())}; }
HWY_INLINE Enclosure hull(const Enclosure& a, const Enclosure& b) { return {min(a.lo, b.lo), max(a.hi, b.hi)}; }
HWY_INLINE Enclosure as_enclosure(const Enclosure& a) { return a; }
HWY_INLINE Enclosure as_enclosure(Batch a) { return {a, a}; }
HWY_INLINE Enclosure as_value(const Enclosure&, Batch k) { return {k, k}; }

HWY_INLINE Enclosure operator-(const Enclosure& a) { return {-a.hi, -a.lo}; }
HWY_INLINE Enclosure operator+(const Enclosure& a, const Enclosure& b) {
  return without_nan(a.lo + b.lo, a.hi + b.hi);
}
HWY_INLINE Enclosure operator-(const Enclosure& a, const Enclosure& b) {
  return without_nan(a.lo - b.hi, a.hi - b.lo);
}
HWY_INLINE Enclosure operator+(const Enclosure& a, Batch b) { return {a.lo + b, a.hi + b}; }
HWY_INLINE Enclosure operator+(Batch a, const Enclosure& b) { return {a + b.lo, a + b.hi}; }
HWY_INLINE Enclosure operator-(const Enclosure& a, Batch b) { return {a.lo - b, a.hi - b}; }
HWY_INLINE Enclosure operator-(Batch a, const Enclosure& b) { return {a - b.hi, a - b.lo}; }

// The sum of the products is NaN if one of the products is NaN, or if they already span the whole line.
HWY_INLINE Enclosure operator*(const Enclosure& a, const Enclosure& b) {
  const Batch p = a.lo * b.lo, q = a.lo * b.hi, r = a.hi * b.lo, s = a.hi * b.hi;
  return whole_where(is_nan((p + q) + (r + s)), {min(min(p, q), min(r, s)), max(max(p, q), max(r, s))});
}
HWY_INLINE Enclosure operator*(const Enclosure& a, Batch b) {
  const Batch p = a.lo * b, q = a.hi * b;
  return whole_where(is_nan(p + q), {min(p, q), max(p, q)});
}
HWY_INLINE Enclosure operator*(Batch a, const Enclosure& b) { return b * a; }

// Divides by a divisor of constant sign, made positive first. A divisor that contains 0 gives the whole line.
HWY_INLINE Enclosure operator/(const Enclosure& a, const Enclosure& b) {
  const Batch zero = Batch::broadcast(0.0f);
  const BatchMask negative = b.hi < zero;
  const Enclosure n{select(negative, -a.hi, a.lo), select(negative, -a.lo, a.hi)};
  const Enclosure d{select(negative, -b.hi, b.lo), select(negative, -b.lo, b.hi)};
  const Batch lo = n.lo / select(n.lo < zero, d.lo, d.hi), hi = n.hi / select(n.hi < zero, d.hi, d.lo);
  const BatchMask both_infinite = (magnitude(a) == infinity()) & (magnitude(b) == infinity());
  return whole_where(contains(b, zero) | both_infinite, {lo, hi});
}
HWY_INLINE Enclosure operator/(const Enclosure& a, Batch b) { return a / as_enclosure(b); }
HWY_INLINE Enclosure operator/(Batch a, const Enclosure& b) { return as_enclosure(a) / b; }

HWY_INLINE EnclosureMask operator<(const Enclosure& a, const Enclosure& b) { return {a.lo < b.hi, a.hi >= b.lo}; }
HWY_INLINE EnclosureMask operator<(const Enclosure& a, Batch b) { return {a.lo < b, a.hi >= b}; }
HWY_INLINE EnclosureMask operator<(Batch a, const Enclosure& b) { return {a < b.hi, a >= b.lo}; }
HWY_INLINE EnclosureMask operator>(const Enclosure& a, const Enclosure& b) { return b < a; }
HWY_INLINE EnclosureMask operator>(const Enclosure& a, Batch b) { return b < a; }
HWY_INLINE EnclosureMask operator>(Batch a, const Enclosure& b) { return b < a; }
HWY_INLINE bool any(const EnclosureMask& mask) { return any(mask.maybe_true); }
HWY_INLINE Enclosure select(const EnclosureMask& mask, const Enclosure& yes, const Enclosure& no) {
  return {min(select(mask.maybe_true, yes.lo, no.lo), select(mask.maybe_false, no.lo, yes.lo)),
          max(select(mask.maybe_true, yes.hi, no.hi), select(mask.maybe_false, no.hi, yes.hi))};
}
HWY_INLINE Enclosure select(const EnclosureMask& mask, Batch yes, Batch no) {
  return select(mask, as_enclosure(yes), as_enclosure(no));
}
HWY_INLINE Enclosure select(BatchMask mask, const Enclosure& yes, const Enclosure& no) {
  return {select(mask, yes.lo, no.lo), select(mask, yes.hi, no.hi)};
}

// min and max return b if an operand is NaN. So if a may be NaN, the result may be any value of b, which the bounds
// include; if b may be NaN, the result may be NaN.
HWY_INLINE Enclosure min(const Enclosure& a, const Enclosure& b) {
  return {min(a.lo, b.lo), select(is_whole(b), infinity(), min(a.hi, b.hi))};
}
HWY_INLINE Enclosure max(const Enclosure& a, const Enclosure& b) {
  return {select(is_whole(b), -infinity(), max(a.lo, b.lo)), max(a.hi, b.hi)};
}
HWY_INLINE Enclosure min(const Enclosure& a, Batch b) { return {min(a.lo, b), min(a.hi, b)}; }
HWY_INLINE Enclosure max(const Enclosure& a, Batch b) { return {max(a.lo, b), max(a.hi, b)}; }
HWY_INLINE Enclosure min(Batch a, const Enclosure& b) { return min(as_enclosure(a), b); }
HWY_INLINE Enclosure max(Batch a, const Enclosure& b) { return max(as_enclosure(a), b); }

// Range of |a|; not valid where a is the whole line, because a may be NaN there.
HWY_INLINE Enclosure sizes(const Enclosure& a) {
  return {max(Batch::broadcast(0.0f), max(a.lo, -a.hi)), magnitude(a)};
}
HWY_INLINE Enclosure squares(const Enclosure& a) {
  const Enclosure m = sizes(a);
  return {m.lo * m.lo, m.hi * m.hi};
}
HWY_INLINE Enclosure abs(const Enclosure& a) { return whole_where(is_whole(a), sizes(a)); }
HWY_INLINE Enclosure sqr(const Enclosure& a) { return whole_where(is_whole(a), squares(a)); }
HWY_INLINE Enclosure sqrt(const Enclosure& a) {
  return whole_where(a.lo < Batch::broadcast(0.0f), {sqrt(a.lo), sqrt(a.hi)});
}
HWY_INLINE Enclosure length(const Enclosure& x, const Enclosure& y) {
  const Enclosure a = squares(x), b = squares(y);
  return whole_where(is_whole(x) | is_whole(y), {sqrt(a.lo + b.lo), sqrt(a.hi + b.hi)});
}
HWY_INLINE Enclosure length(const Enclosure& x, const Enclosure& y, const Enclosure& z) {
  const Enclosure a = squares(x), b = squares(y), c = squares(z);
  return whole_where(is_whole(x) | is_whole(y) | is_whole(z), {sqrt(a.lo + b.lo + c.lo), sqrt(a.hi + b.hi + c.hi)});
}

HWY_INLINE Enclosure floor(const Enclosure& a) { return {floor(a.lo), floor(a.hi)}; }
HWY_INLINE Enclosure ceil(const Enclosure& a) { return {ceil(a.lo), ceil(a.hi)}; }
HWY_INLINE Enclosure round_nearest(const Enclosure& a) { return {round_nearest(a.lo), round_nearest(a.hi)}; }

}  // namespace fathom::vm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
