// Elementary functions and step functions of Slope. A kernel's own error is its measured maximum, rounded up; an ulp
// counts as two units of 2^-24.
#if defined(FATHOM_VM_SLOPE_ELEMENTARY_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef FATHOM_VM_SLOPE_ELEMENTARY_INL
#undef FATHOM_VM_SLOPE_ELEMENTARY_INL
#else
#define FATHOM_VM_SLOPE_ELEMENTARY_INL
#endif

#include "vm/number/slope-inl.h"

HWY_BEFORE_NAMESPACE();
namespace fathom::vm::HWY_NAMESPACE {

inline constexpr double kKernelUnits = 8;   // 4 ulp
inline constexpr double kAngleLimit = 1e4;  // up to here the f32 kernels keep their error bound

// Returns f(a) with range v. `slope`: range of f's derivative over the exact operands; `seen_slope`, `seen_v`: ranges
// of derivative and value over the f32 operands.
inline Slope smooth(const Slope& a, Interval v, Interval slope, Interval seen_slope, Interval seen_v) {
  return chain(a, v, slope, times(magnitude(seen_slope), a.error()) + rounding(kKernelUnits * magnitude(seen_v)));
}
// Error of sine and cosine beyond kAngleLimit: both the exact and the f32 value are in [-1, 1], but the sine of an
// overflowed angle is NaN.
inline double wave_error(Interval s) { return magnitude(s) < 3.4e38 ? 2 / kUnit : kUnbounded; }
inline bool jumps_by_multiple(const Slope& a, Interval period) {
  return a.discontinuity.is_jump() && a.discontinuity.is_step_multiple_of(period);
}
inline Interval whole_turn() { return outward(2 * kPi, 2 * kPi); }
inline Slope sin(const Slope& a) {
  if (jumps_by_multiple(a, whole_turn())) return sin(without_jump(a));
  const Interval s = seen(a);
  Slope r = smooth(a, sin(a.v), cos(a.v), cos(s), sin(s));
  if (!(magnitude(s) <= kAngleLimit)) r.below = r.above = wave_error(s);
  return r;
}
inline Slope cos(const Slope& a) {
  if (jumps_by_multiple(a, whole_turn())) return cos(without_jump(a));
  const Interval s = seen(a);
  Slope r = smooth(a, cos(a.v), -sin(a.v), sin(s), cos(s));
  if (!(magnitude(s) <= kAngleLimit)) r.below = r.above = wave_error(s);
  return r;
}
inline Slope tan(const Slope& a) {
  const Interval s = seen(a), t = tan(s), one{1, 1};
  if (!(magnitude(s) <= kAngleLimit) || !(magnitude(t) < kUnbounded)) return jump(whole_line(), whole_line());
  return smooth(a, tan(a.v), one + sqr(tan(a.v)), one + sqr(t), t);
}
// Range of the derivative 1/sqrt(1 - x^2), which is 0 where |x| > 1 and unbounded near 1.
inline Interval asin_slope(Interval x) {
  const Interval one{1, 1}, m = abs(x);
  if (m.lo > 1) return {0, 0};
  if (!(m.hi < 1)) return {0, kUnbounded};
  return one / sqrt((one - m) * (one + m));
}
// The derivative gives no bound near 1; there, |asin a - asin b| <= pi/2 sqrt|a - b|.
inline double asin_error(const Slope& a, Interval value) {
  const double by_root = kPi / 2 * std::sqrt(a.error() / kUnit);
  return bound(std::min(times(magnitude(asin_slope(seen(a))), a.error()), by_root)) +
         rounding(kKernelUnits * magnitude(value));
}
inline Slope asin(const Slope& a) { return chain(a, asin(a.v), asin_slope(a.v), asin_error(a, asin(seen(a)))); }
inline Slope acos(const Slope& a) { return chain(a, acos(a.v), -asin_slope(a.v), asin_error(a, acos(seen(a)))); }
inline Slope atan(const Slope& a) {
  const Interval s = seen(a), one{1, 1};
  return smooth(a, atan(a.v), one / (one + sqr(a.v)), one / (one + sqr(s)), atan(s));
}
inline Slope atan2(const Slope& y, const Slope& x) {
  const Interval sy = seen(y), sx = seen(x);
  const Interval angle = atan2(sy, sx), square = sqr(y.v) + sqr(x.v), seen_square = sqr(sy) + sqr(sx);
  const bool jumps = contains(sy, 0) && sx.lo <= 0;  // the branch cut
  if (jumps && !(sx.hi < 0)) return jump(angle, angle);
  const Interval u = x.v / square, w = y.v / square;
  const double steepest = 1 / std::sqrt(seen_square.lo);
  const Slope r = make_slope(atan2(y.v, x.v), u * y.dx - w * x.dx, u * y.dy - w * x.dy, u * y.dz - w * x.dz,
                             (y.norm + x.norm) / std::sqrt(square.lo),
                             (y.error() + x.error()) * steepest + rounding(kKernelUnits * magnitude(angle)));
  if (!jumps) return r;
  Slope broken = jump(angle, angle);
  broken.discontinuity = jump_of_angle(continuous(r));
  return broken;
}
inline Slope exp(const Slope& a) {
  Slope r = smooth(a, exp(a.v), exp(a.v), exp(seen(a)), exp(seen(a)));
  r.nonnegative = true;
  constexpr double kOwn = kKernelUnits * kRoundedLogarithm;
  r.logarithm = make_logarithm(a.v, a.dx, a.dy, a.dz, a.norm, a.below + kOwn, a.above + kOwn, 0);
  if (a.discontinuity.is_pole()) {
    r.logarithm.pole = a.discontinuity;
    r.logarithm.pole.error += kOwn;
  }
  return r;
}
// Returns the logarithm of a value by the bounds that it has kept of it.
inline Slope kept_log(const Logarithm& a) {
  // ln(u + tiny) - ln u is greatest where u is smallest.
  const double tiny = a.tiny > 0 ? log_of_sum(0, log(Real{a.tiny}).v - a.v.lo) / kUnit : 0;
  const double below = a.below, above = bound(a.above + tiny);
  const auto kernel = [](double lo, double hi) { return rounding(kKernelUnits * magnitude(outward(lo, hi))); };
  return make_slope(a.v, a.dx, a.dy, a.dz, a.norm, below + kernel(a.v.lo - bound(below * kUnit), a.v.hi),
                    above + kernel(a.v.lo, a.v.hi + bound(above * kUnit)));
}
inline Slope log(const Slope& a) {
  const Interval s = seen(a), one{1, 1};
  if (a.logarithm.known && is_normal(a.logarithm.v)) return kept_log(a.logarithm);
  if (!(s.lo > 0)) {
    Slope r = jump(log(a.v), log(a.v));
    r.below = r.above = kUnbounded;
    return r;
  }
  return smooth(a, log(a.v), one / a.v, one / s, log(s));
}

// Returns x^y for y equal to the integer n, with derivative n x^(n-1). The kernel's relative error is
// (2 + 2 |n log x|) ulp, and t |log t| <= max(1/e, M log M) for t = |x|^n up to M.
inline Slope whole_power(const Slope& x, const Slope& y, double n) {
  const Interval s = seen(x), exponent{n, n}, less{n - 1, n - 1};
  const double size = magnitude(pow(s, exponent));
  const double kernel = 8 * size + 8 * std::max(0.37, size > 1 ? size * log(Real{size}).v : 0.0);
  Slope r = chain(x, pow(x.v, y.v), exponent * pow(x.v, less),
                  times(magnitude(exponent * pow(s, less)), x.error()) + rounding(kernel));
  r.nonnegative = x.nonnegative || mod(Real{n}, Real{2}).v == 0;
  return r;
}
inline Slope pow(const Slope& x, const Slope& y) {
  const double n = round_nearest(Real{y.v.lo}).v;
  if (y.norm == 0 && y.error() == 0 && y.v.hi - y.v.lo < 1e-9 && contains(y.v, n)) {
    if (n == 0) return exactly({1, 1});
    if (n > 0 || !contains(seen(x), 0)) return whole_power(x, y, n);
  }
  if (seen(x).lo > 0) {  // exp(y log x), as the kernel computes the power
    Slope r = exp(y * log(x));
    r.v = {std::max(r.v.lo, pow(x.v, y.v).lo), std::min(r.v.hi, pow(x.v, y.v).hi)};
    return r;
  }
  Slope r = jump(pow(x.v, y.v), whole_line());
  // A power of an x that may be 0 but not negative: t |log t| as in whole_power(), and the f32 and the exact |x|^y
  // differ by at most the width of the range.
  if (x.nonnegative && y.v.lo > 0) {
    const Interval range = pow(seen(x), seen(y));
    r.below = r.above =
        bound((range.hi - range.lo) / kUnit + 8 * range.hi + 8 * range.hi * std::fabs(log(Real{range.hi + 1}).v) + 8);
    if (y.norm == 0 && y.v.lo > 1.0) {
      const Interval slope = y.v * pow(x.v, y.v - Interval{1, 1});
      return chain(x, r.v, slope, r.error());
    }
  }
  return r;
}

// Returns a value without a bound on its error if that of an operand has none: the f32 value may be NaN.
inline Slope or_nan(Slope result, const Slope& a) {
  if (maybe_nan(a)) result.below = result.above = kUnbounded;
  return result;
}
// Value of a step function: constant if f32 and exact arithmetic agree on one step.
inline Slope steps(Interval v, Interval alternatives) {
  return alternatives.lo == alternatives.hi ? exactly(alternatives) : jump(v, alternatives);
}
inline Slope floor(const Slope& a) { return or_nan(steps(floor(a.v), floor(seen(a))), a); }
inline Slope ceil(const Slope& a) { return or_nan(steps(ceil(a.v), ceil(seen(a))), a); }
inline Slope round_nearest(const Slope& a) { return or_nan(steps(round_nearest(a.v), round_nearest(seen(a))), a); }
inline Slope sign(const Slope& a) { return or_nan(steps(sign(a.v), sign(seen(a))), a); }
inline Slope logical_not(const Slope& a) { return or_nan(steps(logical_not(a.v), logical_not(seen(a))), a); }
inline Slope compare(const Slope& a, const Slope& b) {
  return or_nan(or_nan(steps(compare(a.v, b.v), compare(seen(a), seen(b))), a), b);
}
inline Slope step(const Slope& edge, const Slope& x) {
  return or_nan(or_nan(steps(step(edge.v, x.v), step(seen(edge), seen(x))), edge), x);
}

inline Slope mod(const Slope& a, const Slope& b) {
  if (contains(seen(b), 0)) return jump(whole_line(), whole_line());
  if (seen(b).hi < 0) return -mod(-a, -b);
  if (b.norm == 0 && jumps_by_multiple(a, b.v)) return mod(without_jump(a), b);
  const Slope turns = floor(a / b);
  if (turns.norm == 0) return a - b * turns;
  // In f32 the rounding of the quotient and the product can leave the period.
  const Interval sa = seen(a), sb = seen(b);
  const double slack = 4 * kUnit * (magnitude(sa) + magnitude(sb));
  Slope r = jump(mod(a.v, b.v), {std::min(0.0, sb.lo) - slack, std::max(0.0, sb.hi) + slack});
  if (b.norm == 0) {
    // Also covers an f32 value of a that is on the other side of a jump, whose step is whole turns.
    const double most_turns = magnitude(hull(turns.v, floor(sa / sb))) + 1;
    r.discontinuity = jumps_of_modulus(continuous(a), b.v, slack / kUnit + times(most_turns, b.error()));
  }
  return or_nan(or_nan(r, a), b);
}
inline Slope logical_and(const Slope& a, const Slope& b) {
  if (!contains(seen(a), 0)) return b;
  if (seen(a).lo == seen(a).hi) return exactly({0, 0});
  return jump(logical_and(a.v, b.v), logical_and(seen(a), seen(b)));
}
inline Slope logical_or(const Slope& a, const Slope& b) {
  if (!contains(seen(a), 0)) return a;
  if (seen(a).lo == seen(a).hi) return b;
  return jump(logical_or(a.v, b.v), logical_or(seen(a), seen(b)));
}

}  // namespace fathom::vm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
