// Logarithm: bounds of ln u over a box, which Slope (slope-inl.h) keeps of a value u made of exponentials. The gradient
// of ln(u + w) is a mean of the gradients of ln u and ln w, weighted by u and w. So smooth unions such as
// -ln(exp(-k a) + exp(-k b)) / k are no steeper than a and b, however small the sum is, also where exp() underflows or
// overflows in f32.
// Tested by: tests/vm/interpret/formula_test.cpp
#if defined(FATHOM_VM_LOGARITHM_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef FATHOM_VM_LOGARITHM_INL
#undef FATHOM_VM_LOGARITHM_INL
#else
#define FATHOM_VM_LOGARITHM_INL
#endif

#include <algorithm>

#include "vm/number/discontinuity-inl.h"
#include "vm/number/interval_elementary-inl.h"

HWY_BEFORE_NAMESPACE();
namespace fathom::vm::HWY_NAMESPACE {

// Copies skip the members when not `known`, as for most values.
struct Logarithm {
  bool known = false;      // false if u may be 0 or negative, and for values without exponentials
  Interval v, dx, dy, dz;  // ranges of ln u and of its partial derivatives
  double norm;             // bound on the length of its gradient
  // The f32 value is in [u exp(-below kUnit), u exp(above kUnit) + tiny]. Infinite `below`: the f32 value may be 0.
  // Infinite `above`: it may be infinite. If both are infinite, it may be NaN.
  double below, above, tiny;
  Discontinuity pole;  // of ln u

  Logarithm() {}
  Logarithm(const Logarithm& other) { *this = other; }
  Logarithm& operator=(const Logarithm& other) {
    known = other.known;
    if (!known) return *this;
    v = other.v, dx = other.dx, dy = other.dy, dz = other.dz, norm = other.norm;
    below = other.below, above = other.above, tiny = other.tiny;
    pole = other.pole;
    return *this;
  }
};

// Natural logarithms between which an f32 value is normal and finite.
inline constexpr double kLeastLogarithm = -87, kLargestLogarithm = 88;
// kRoundedLogarithm: error of a rounding to f32, as an error of the logarithm, in kUnit. kSubnormal: maximum absolute
// error of a subnormal result.
inline constexpr double kRoundedLogarithm = 1.001, kSubnormal = 0x1p-126;
inline constexpr double kFarAbove = -66;  // far above the logarithm of kSubnormal

// Returns the bounds of an f32 result, given its errors without underflow and overflow.
inline Logarithm make_logarithm(Interval v, Interval dx, Interval dy, Interval dz, double norm, double below,
                                double above, double tiny) {
  // Above kFarAbove, so many subnormal errors are a relative error of less than a unit.
  constexpr double kMostTiny = 64 * kSubnormal;
  Logarithm r;
  r.known = true;
  r.v = v, r.dx = dx, r.dy = dy, r.dz = dz;
  r.norm = bound(norm), r.below = bound(below), r.above = bound(above), r.tiny = tiny;
  if (!(v.lo - r.below * kUnit > kLeastLogarithm)) r.below = kUnbounded, r.tiny += kSubnormal;
  if (!(v.hi + r.above * kUnit < kLargestLogarithm)) r.above = kUnbounded;
  if (r.tiny > 0 && r.tiny <= kMostTiny && v.lo > kFarAbove) r.above += 1, r.tiny = 0;
  return r;
}

// True if a double with a logarithm in v is normal and finite, and so has the accuracy of its logarithm.
inline bool is_normal(Interval v) { return v.lo > -700 && v.hi < 700; }

// Returns e^a / (e^a + e^b) for difference = b - a, within 1e-14.
inline double logistic(double difference) {
  if (difference > 0) return 1 - logistic(-difference);
  return 1 / (1 + exp(Real{difference}).v);
}
inline constexpr double kLn2 = 0.6931471805599453;
// Returns ln(e^a + e^b), within 1e-14 of the larger.
inline double log_of_sum(double a, double b) {
  if (a == b) return a + kLn2;  // also if both are infinite
  return std::max(a, b) + log(Real{1 + exp(Real{-std::fabs(a - b)}).v}).v;
}

// The range of the weight u / (u + w) of the gradient of a = ln u in that of ln(u + w), where b = ln w.
struct LogWeight {
  double least, most;

  LogWeight(Interval a, Interval b)
      : least(std::max(0.0, logistic(b.hi - a.lo) - kSlack)), most(std::min(1.0, logistic(b.lo - a.hi) + kSlack)) {}
  static double mix(double weight, double x, double y) { return times(weight, x) + times(1 - weight, y); }
  Interval mean(Interval x, Interval y) const {
    const auto slack = [](double a, double b) { return kRoundings * (std::fabs(a) + std::fabs(b)); };
    return outward(std::min(mix(least, x.lo, y.lo), mix(most, x.lo, y.lo)) - slack(x.lo, y.lo),
                   std::max(mix(least, x.hi, y.hi), mix(most, x.hi, y.hi)) + slack(x.hi, y.hi));
  }
  double mean(double x, double y) const { return std::max(mix(least, x, y), mix(most, x, y)); }

  // kSlack: more than the error of logistic(). kRoundings: more than that of mix(), relative to its operands.
  static constexpr double kSlack = 1e-13, kRoundings = 1e-15;
};
// Returns the range of ln(u + w), given those of a = ln u and b = ln w.
inline Interval log_of_sum(Interval a, Interval b) {
  constexpr double kSlack = 1e-13;
  const double lo = log_of_sum(a.lo, b.lo), hi = log_of_sum(a.hi, b.hi);
  return {lo - kSlack * (1 + std::fabs(lo)), hi + kSlack * (1 + std::fabs(hi))};
}

// Returns the bounds of ln(u + w), given those of a = ln u, which tends to minus infinity at a pole, and of b = ln w.
inline Logarithm log_sum_at_pole(const Logarithm& a, const Logarithm& b) {
  if (b.pole.known() || !a.pole.tends_to(-kUnbounded) || !(b.v.lo > kFarAbove && b.below + b.above < kUnbounded))
    return {};
  const Discontinuity& p = a.pole;
  const double least = b.v.lo - b.below * kUnit;
  const double norm = bound(b.norm + weighted(p.middle, p.slope, p.slope_growth, p.reach.hi, least));
  const double error = weighted(p.middle, p.error, p.error_growth, p.reach.hi, least);
  const Interval all{-norm, norm};
  constexpr double kFlushed = 1;  // more than the share of a u that underflows in a normal sum
  return make_logarithm(log_of_sum(a.v, b.v), all, all, all, norm, b.below + error + kFlushed + kRoundedLogarithm,
                        b.above + error + kFlushed + kRoundedLogarithm, b.tiny);
}
// Returns the bounds of ln(u + w), given those of a = ln u and b = ln w.
inline Logarithm log_sum(const Logarithm& a, const Logarithm& b) {
  if (a.pole.known()) return log_sum_at_pole(a, b);
  if (b.pole.known()) return log_sum_at_pole(b, a);
  const LogWeight weight(a.v, b.v);
  // If only u may underflow, the f32 sum is at least w, a share 1 - most of the exact sum.
  const bool maybe_nan = !(std::min(a.below, a.above) < kUnbounded && std::min(b.below, b.above) < kUnbounded);
  const double below = maybe_nan
                           ? kUnbounded
                           : std::min({std::max(a.below, b.below), b.below - log(Real{1 - weight.most}).v / kUnit,
                                       a.below - log(Real{weight.least}).v / kUnit});
  return make_logarithm(log_of_sum(a.v, b.v), weight.mean(a.dx, b.dx), weight.mean(a.dy, b.dy),
                        weight.mean(a.dz, b.dz), weight.mean(a.norm, b.norm), below + kRoundedLogarithm,
                        maybe_nan ? kUnbounded : std::max(a.above, b.above) + kRoundedLogarithm, a.tiny + b.tiny);
}
inline Logarithm log_product(const Logarithm& a, const Logarithm& b) {
  if (!is_normal(a.v) || !is_normal(b.v)) return {};
  const double above = a.tiny + b.tiny > 0 ? kUnbounded : a.above + b.above;
  return make_logarithm(a.v + b.v, a.dx + b.dx, a.dy + b.dy, a.dz + b.dz, a.norm + b.norm,
                        a.below + b.below + kRoundedLogarithm, above + kRoundedLogarithm, 0);
}
inline Logarithm log_quotient(const Logarithm& a, const Logarithm& b) {
  if (!is_normal(a.v) || !is_normal(b.v)) return {};
  const double below = b.tiny > 0 ? kUnbounded : a.below + b.above, above = a.tiny > 0 ? kUnbounded : a.above + b.below;
  return make_logarithm(a.v - b.v, a.dx - b.dx, a.dy - b.dy, a.dz - b.dz, a.norm + b.norm, below + kRoundedLogarithm,
                        above + kRoundedLogarithm, 0);
}

}  // namespace fathom::vm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
