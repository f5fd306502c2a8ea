// Interval: all values f can take while x, y, z range over a box. Bounds are rounded outwards after every operation
// by one ulp or more, so the exact result is always inside. An undecided comparison gives the hull of both answers. A
// NaN bound gives the whole line. The elementary functions are in interval_elementary-inl.h. Source: Moore, "Interval
// Analysis", 1966.
#if defined(FATHOM_VM_INTERVAL_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef FATHOM_VM_INTERVAL_INL
#undef FATHOM_VM_INTERVAL_INL
#else
#define FATHOM_VM_INTERVAL_INL
#endif

#include <algorithm>
#include <cmath>
#include <limits>

#include "vm/number/real-inl.h"

HWY_BEFORE_NAMESPACE();
namespace fathom::vm::HWY_NAMESPACE {

struct Interval {
  using Constant = Interval;
  double lo, hi;

  // Widens a constant by one ulp either way: the constant was rounded once when derived from a scene's numbers, so
  // the interval contains the unrounded value.
  static inline Interval broadcast(double value);
};

// Result of a comparison over a box: the comparison can hold somewhere, fail somewhere, or both.
struct IntervalMask {
  bool maybe_true, maybe_false;
};

inline Interval whole_line() {
  const double inf = std::numeric_limits<double>::infinity();
  return {-inf, inf};
}
// Returns [lo, hi] widened by at least half an ulp; `lo` and `hi` are correctly rounded.
inline Interval outward(double lo, double hi) {
  constexpr double kUlp = 2.3e-16, kTiny = 5e-324, kLargest = std::numeric_limits<double>::max();
  if (!(lo <= hi)) return whole_line();
  // An overflowed bound stands for a finite value beyond the largest double, not for infinity.
  lo = std::min(lo, kLargest);
  hi = std::max(hi, -kLargest);
  return {lo < -kLargest ? lo : lo - std::fabs(lo) * kUlp - kTiny,
          hi > kLargest ? hi : hi + std::fabs(hi) * kUlp + kTiny};
}
inline Interval hull(Interval a, Interval b) { return {std::min(a.lo, b.lo), std::max(a.hi, b.hi)}; }
// Product in which 0 * infinity is 0: the infinity stands for arbitrarily large finite values.
inline double times(double a, double b) { return a == 0 || b == 0 ? 0 : a * b; }

inline Interval Interval::broadcast(double value) { return value == 0 ? Interval{0, 0} : outward(value, value); }

inline Interval operator+(Interval a, Interval b) { return outward(a.lo + b.lo, a.hi + b.hi); }
inline Interval operator-(Interval a, Interval b) { return outward(a.lo - b.hi, a.hi - b.lo); }
inline Interval operator-(Interval a) { return {-a.hi, -a.lo}; }
inline Interval operator*(Interval a, Interval b) {
  const double p = times(a.lo, b.lo), q = times(a.lo, b.hi), r = times(a.hi, b.lo), s = times(a.hi, b.hi);
  return outward(std::min(std::min(p, q), std::min(r, s)), std::max(std::max(p, q), std::max(r, s)));
}
inline Interval operator/(Interval a, Interval b) {
  if (b.lo <= 0 && b.hi >= 0) return whole_line();
  return a * outward(1 / b.hi, 1 / b.lo);
}
inline IntervalMask operator<(Interval a, Interval b) { return {a.lo < b.hi, a.hi >= b.lo}; }
inline IntervalMask operator>(Interval a, Interval b) { return b < a; }
inline bool any(IntervalMask mask) { return mask.maybe_true; }
inline Interval select(IntervalMask mask, Interval yes, Interval no) {
  if (!mask.maybe_false) return yes;
  if (!mask.maybe_true) return no;
  return hull(yes, no);
}
inline Interval min(Interval a, Interval b) { return {std::min(a.lo, b.lo), std::min(a.hi, b.hi)}; }
inline Interval max(Interval a, Interval b) { return {std::max(a.lo, b.lo), std::max(a.hi, b.hi)}; }
inline Interval abs(Interval a) {
  if (a.lo >= 0) return a;
  if (a.hi <= 0) return -a;
  return {0, std::max(-a.lo, a.hi)};
}
inline Interval sqr(Interval a) {
  const Interval m = abs(a);
  const Interval square = outward(m.lo * m.lo, m.hi * m.hi);
  return {std::max(0.0, square.lo), square.hi};
}
inline Interval sqrt(Interval a) {
  const Interval root = outward(std::sqrt(std::max(0.0, a.lo)), std::sqrt(std::max(0.0, a.hi)));
  return {std::max(0.0, root.lo), root.hi};
}
inline Interval length(Interval x, Interval y) { return sqrt(sqr(x) + sqr(y)); }
inline Interval length(Interval x, Interval y, Interval z) { return sqrt(sqr(x) + sqr(y) + sqr(z)); }

}  // namespace fathom::vm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
