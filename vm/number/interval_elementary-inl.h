// Elementary functions of Interval: Real's kernels at the ends, widened by kKernelSlack, which is far above the
// kernels' error. If a function is undefined in part of the operand, the result is the hull over the rest; if
// undefined in all of it, the whole line. So a range does not hold at points where a part of the formula is
// undefined. A jump inside the operand gives the hull of both sides.
#if defined(FATHOM_VM_INTERVAL_ELEMENTARY_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef FATHOM_VM_INTERVAL_ELEMENTARY_INL
#undef FATHOM_VM_INTERVAL_ELEMENTARY_INL
#else
#define FATHOM_VM_INTERVAL_ELEMENTARY_INL
#endif

#include "vm/number/elementary-inl.h"
#include "vm/number/interval-inl.h"

HWY_BEFORE_NAMESPACE();
namespace fathom::vm::HWY_NAMESPACE {

inline constexpr double kKernelSlack = 4e-14;  // relative
inline constexpr double kPi = 3.14159265358979323846;

inline bool contains(Interval a, double x) { return a.lo <= x && x <= a.hi; }
inline double magnitude(Interval a) { return std::max(std::fabs(a.lo), std::fabs(a.hi)); }
inline Interval intersect(Interval a, double lo, double hi) {
  return {std::clamp(a.lo, lo, hi), std::clamp(a.hi, lo, hi)};
}

// Returns [lo, hi] widened by the kernels' error.
inline Interval kernel_range(double lo, double hi) {
  return outward(lo - std::fabs(lo) * kKernelSlack, hi + std::fabs(hi) * kKernelSlack);
}
// Range of a nondecreasing function f.
template <class F>
inline Interval rising(Interval a, const F& f) {
  return kernel_range(f(Real{a.lo}).v, f(Real{a.hi}).v);
}

inline Interval floor(Interval a) { return {floor(Real{a.lo}).v, floor(Real{a.hi}).v}; }
inline Interval ceil(Interval a) { return {ceil(Real{a.lo}).v, ceil(Real{a.hi}).v}; }
inline Interval round_nearest(Interval a) { return {round_nearest(Real{a.lo}).v, round_nearest(Real{a.hi}).v}; }
inline Interval sign(Interval a) { return {sign(Real{a.lo}).v, sign(Real{a.hi}).v}; }

// True if `a` contains, or may contain, offset + n period for some integer n.
inline bool passes_multiple(Interval a, double offset, double period) {
  constexpr double kSlack = 1e-9;  // in periods; a's ends stay below 1e6
  const double from = (a.lo - offset) / period - kSlack, to = (a.hi - offset) / period + kSlack;
  return !(floor(Real{to}).v < from);
}
// Range of a sine wave that has a maximum at `offset`; `at_lo` and `at_hi` are its values at a's ends.
inline Interval wave(Interval a, double at_lo, double at_hi, double offset) {
  if (!(magnitude(a) <= 1e6)) return {-1, 1};
  const Interval ends = kernel_range(std::min(at_lo, at_hi), std::max(at_lo, at_hi));
  const bool top = passes_multiple(a, offset, 2 * kPi), bottom = passes_multiple(a, offset + kPi, 2 * kPi);
  return {bottom ? -1 : std::max(-1.0, ends.lo), top ? 1 : std::min(1.0, ends.hi)};
}
inline Interval sin(Interval a) { return wave(a, sin(Real{a.lo}).v, sin(Real{a.hi}).v, kPi / 2); }
inline Interval cos(Interval a) { return wave(a, cos(Real{a.lo}).v, cos(Real{a.hi}).v, 0); }
inline Interval tan(Interval a) {
  if (!(magnitude(a) <= 1e6) || passes_multiple(a, kPi / 2, kPi)) return whole_line();
  return rising(a, [](Real x) HWY_ATTR { return tan(x); });
}
inline Interval asin(Interval a) {
  return rising(a, [](Real x) HWY_ATTR { return asin(x); });
}
inline Interval acos(Interval a) { return kernel_range(acos(Real{a.hi}).v, acos(Real{a.lo}).v); }
inline Interval atan(Interval a) {
  return rising(a, [](Real x) HWY_ATTR { return atan(x); });
}
// Over a box that touches neither the origin nor the branch cut (y = 0, x <= 0), the extremes are at corners.
inline Interval atan2(Interval y, Interval x) {
  if (x.lo <= 0 && contains(y, 0)) return kernel_range(-kPi, kPi);
  double lo = kPi, hi = -kPi;
  for (double at_y : {y.lo, y.hi}) {
    for (double at_x : {x.lo, x.hi}) {
      const double angle = atan2(Real{at_y}, Real{at_x}).v;
      lo = std::min(lo, angle), hi = std::max(hi, angle);
    }
  }
  return kernel_range(lo, hi);
}
inline Interval exp(Interval a) {
  const Interval range = rising(a, [](Real x) HWY_ATTR { return exp(x); });
  return {std::max(0.0, range.lo), range.hi};
}
inline Interval log(Interval a) {
  if (!(a.hi > 0)) return whole_line();
  return rising({std::max(0.0, a.lo), a.hi}, [](Real x) HWY_ATTR { return log(x); });
}

inline Interval mod(Interval a, Interval b) {
  if (contains(b, 0)) return whole_line();
  const Interval turns = floor(a / b);
  if (turns.lo == turns.hi) return a - b * turns;
  // The result is within one period, except for the rounding of the quotient and the product.
  const double slack = 4e-16 * (magnitude(a) + magnitude(b));
  return {std::min(0.0, b.lo) - slack, std::max(0.0, b.hi) + slack};
}
inline Interval logical_not(Interval a) {
  if (a.lo == 0 && a.hi == 0) return {1, 1};
  return {0, contains(a, 0) ? 1.0 : 0.0};
}
inline Interval logical_and(Interval a, Interval b) {
  if (!contains(a, 0)) return b;
  return a.lo == a.hi ? Interval{0, 0} : hull({0, 0}, b);
}
inline Interval logical_or(Interval a, Interval b) {
  if (!contains(a, 0)) return a;
  return a.lo == a.hi ? b : hull(a, b);
}
inline Interval compare(Interval a, Interval b) {
  const bool equal = a.lo == a.hi && b.lo == b.hi && a.lo == b.lo;
  if (equal) return {0, 0};
  return {a.lo < b.hi ? -1.0 : (a.lo == b.hi ? 0.0 : 1.0), b.lo < a.hi ? 1.0 : (b.lo == a.hi ? 0.0 : -1.0)};
}
inline Interval step(Interval edge, Interval x) { return {x.lo < edge.hi ? 0.0 : 1.0, x.hi < edge.lo ? 0.0 : 1.0}; }

// Range of x^y over x in [a.lo, a.hi], both >= 0.
inline Interval positive_power(Interval a, Interval y) {
  double lo = std::numeric_limits<double>::infinity(), hi = 0;
  for (double base : {a.lo, a.hi}) {
    for (double exponent : {y.lo, y.hi}) {
      const double value = pow(Real{base}, Real{exponent}).v;
      lo = std::min(lo, value), hi = std::max(hi, value);
    }
  }
  if (a.lo == 0 && contains(y, 0)) lo = std::min(lo, 0.0), hi = std::max(hi, 1.0);
  if (contains(y, 0)) lo = std::min(lo, 1.0), hi = std::max(hi, 1.0);
  if (std::isnan(lo) || std::isnan(hi)) return {0, std::numeric_limits<double>::infinity()};
  // The kernel's relative error grows with |y log x|, which is at most 750 between underflow and overflow.
  const Interval doubles = outward(lo * (1 - 1e-12), hi * (1 + 1e-12));
  return {std::max(0.0, doubles.lo), doubles.hi};
}
inline Interval pow(Interval x, Interval y) {
  const Real first = ceil(Real{y.lo}), last = floor(Real{y.hi});
  if (!(x.lo < 0)) return positive_power(x, y);
  const bool defined_below = first.v <= last.v;  // negative x have powers only for integer exponents
  if (!defined_below) return x.hi < 0 ? whole_line() : positive_power({0, x.hi}, y);
  const Interval below = positive_power({std::max(0.0, -x.hi), -x.lo}, {first.v, last.v});
  const bool one = first.v == last.v;
  const bool odd = one && mod(first, Real{2}).v == 1;
  const Interval negative = one ? (odd ? -below : below) : Interval{-below.hi, below.hi};
  return x.hi < 0 ? negative : hull(negative, positive_power({0, x.hi}, y));
}

}  // namespace fathom::vm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
