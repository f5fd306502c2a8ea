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

#include "vm/number/interval_elementary-inl.h"

HWY_BEFORE_NAMESPACE();
namespace fathom::vm::HWY_NAMESPACE {

inline constexpr double kUnbounded = std::numeric_limits<double>::infinity();
inline constexpr double kUnit = 0x1p-24;  // unit of errors

// Increases a bound by more than the rounding of the nonnegative doubles that it is a sum or product of. A NaN
// becomes kUnbounded.
inline double bound(double value) { return value >= 0 ? value * (1 + 1e-14) : kUnbounded; }

// Copies skip the members when not `known`, as for most values.
struct Logarithm {
  bool known = false;      // false if u may be 0 or negative, and for values without exponentials
  Interval v, dx, dy, dz;  // ranges of ln u and of its partial derivatives
  double norm;             // bound on the length of its gradient
  // The f32 value is in [u exp(-below kUnit), u exp(above kUnit) + tiny]. Infinite `below`: the f32 value may be 0.
  // Infinite `above`: it may be infinite. If both are infinite, it may be NaN.
  double below, above, tiny;

  Logarithm() {}
  Logarithm(const Logarithm& other) { *this = other; }
  Logarithm& operator=(const Logarithm& other) {
    known = other.known;
    if (!known) return *this;
    v = other.v, dx = other.dx, dy = other.dy, dz = other.dz, norm = other.norm;
    below = other.below, above = other.above, tiny = other.tiny;
    return *this;
  }
};

// Natural logarithms between which an f32 value is normal and finite.
inline constexpr double kLeastLogarithm = -87, kLargestLogarithm = 88;
// kRoundedLogarithm: error of a rounding to f32, as an error of the logarithm, in kUnit. kSubnormal: maximum absolute
// error of a subnormal result.
inline constexpr double kRoundedLogarithm = 1.001, kSubnormal = 0x1p-126;

// Returns the bounds of an f32 result, given its errors without underflow and overflow.
inline Logarithm make_logarithm(Interval v, Interval dx, Interval dy, Interval dz, double norm, double below,
                                double above, double tiny) {
  // Above this logarithm, subnormal errors are relative errors of less than a unit.
  constexpr double kFarAbove = -66;
  Logarithm r;
  r.known = true;
  r.v = v, r.dx = dx, r.dy = dy, r.dz = dz;
  r.norm = bound(norm), r.below = bound(below), r.above = bound(above), r.tiny = tiny;
  if (!(v.lo - r.below * kUnit > kLeastLogarithm)) r.below = kUnbounded, r.tiny += kSubnormal;
  if (!(v.hi + r.above * kUnit < kLargestLogarithm)) r.above = kUnbounded;
  constexpr double kMostTiny = 64 * kSubnormal;
  if (r.tiny > 0 && r.tiny <= kMostTiny && v.lo > kFarAbove) r.above += 64, r.tiny = 0;
  return r;
}

// Returns e^a / (e^a + e^b) for difference = b - a, within 1e-14.
inline double logistic(double difference) {
  if (difference > 0) return 1 - logistic(-difference);
  return 1 / (1 + exp(Real{difference}).v);
}
// Returns ln(e^a + e^b), within 1e-14 of the larger.
inline double log_of_sum(double a, double b) {
  return std::max(a, b) + log(Real{1 + exp(Real{-std::fabs(a - b)}).v}).v;
}

// Returns the bounds of ln(u + w), given those of a = ln u and b = ln w.
inline Logarithm log_sum(const Logarithm& a, const Logarithm& b) {
  constexpr double kSlack = 1e-13;
  // The range of the weight of a's gradient.
  const double least = std::max(0.0, logistic(b.v.hi - a.v.lo) - kSlack),
               most = std::min(1.0, logistic(b.v.lo - a.v.hi) + kSlack);
  const auto mix = [](double weight, double x, double y) { return times(weight, x) + times(1 - weight, y); };
  const auto mean = [&](Interval x, Interval y) {
    return outward(std::min(mix(least, x.lo, y.lo), mix(most, x.lo, y.lo)),
                   std::max(mix(least, x.hi, y.hi), mix(most, x.hi, y.hi)));
  };
  const double lo = log_of_sum(a.v.lo, b.v.lo), hi = log_of_sum(a.v.hi, b.v.hi);
  // If only u may underflow, the f32 sum is at least w, a share 1 - most of the exact sum.
  const bool maybe_nan = !(std::min(a.below, a.above) < kUnbounded && std::min(b.below, b.above) < kUnbounded);
  const double below = maybe_nan ? kUnbounded
                                 : std::min({std::max(a.below, b.below), b.below - log(Real{1 - most}).v / kUnit,
                                             a.below - log(Real{least}).v / kUnit});
  return make_logarithm({lo - kSlack * (1 + std::fabs(lo)), hi + kSlack * (1 + std::fabs(hi))}, mean(a.dx, b.dx),
                        mean(a.dy, b.dy), mean(a.dz, b.dz),
                        std::max(mix(least, a.norm, b.norm), mix(most, a.norm, b.norm)), below + kRoundedLogarithm,
                        maybe_nan ? kUnbounded : std::max(a.above, b.above) + kRoundedLogarithm, a.tiny + b.tiny);
}
inline Logarithm log_product(const Logarithm& a, const Logarithm& b) {
  const double above = a.tiny + b.tiny > 0 ? kUnbounded : a.above + b.above;
  return make_logarithm(a.v + b.v, a.dx + b.dx, a.dy + b.dy, a.dz + b.dz, a.norm + b.norm,
                        a.below + b.below + kRoundedLogarithm, above + kRoundedLogarithm, 0);
}
inline Logarithm log_quotient(const Logarithm& a, const Logarithm& b) {
  const double below = b.tiny > 0 ? kUnbounded : a.below + b.above, above = a.tiny > 0 ? kUnbounded : a.above + b.below;
  return make_logarithm(a.v - b.v, a.dx - b.dx, a.dy - b.dy, a.dz - b.dz, a.norm + b.norm, below + kRoundedLogarithm,
                        above + kRoundedLogarithm, 0);
}

}  // namespace fathom::vm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
