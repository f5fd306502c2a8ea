// Discontinuity: bounds of a value over a box in which the value jumps or is infinite, kept by Slope (slope-inl.h).
// Away from the places where that happens, the value has bounds. These become the bounds of a function that is the
// same on both sides of such a place:
//
//     abs(mod(x, 1) - 0.5)                             the modulus jumps from 1 to 0, the function has slope 1
//     -ln(exp(-k a) + exp(-k abs(c / x))) / k          the quotient is infinite at x = 0, where its exponential is 0
//
// The slope of a quotient has no bound, but grows no faster than the square of the value, because the slope of c / x
// is (c / x)^2 / c. An exponential that falls outweighs a square.
//
// Errors count as paths from the exact value to the f32 value. An error of x moves the value along its graph, perhaps
// through a discontinuity.
// Tested by: tests/vm/interpret/formula_test.cpp
#if defined(FATHOM_VM_DISCONTINUITY_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef FATHOM_VM_DISCONTINUITY_INL
#undef FATHOM_VM_DISCONTINUITY_INL
#else
#define FATHOM_VM_DISCONTINUITY_INL
#endif

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "vm/number/error_units-inl.h"
#include "vm/number/interval_elementary-inl.h"

HWY_BEFORE_NAMESPACE();
namespace fathom::vm::HWY_NAMESPACE {

// A value without discontinuities: the ranges of its exact values, of its exact and its f32 values and of its partial
// derivatives, bounds on its gradient's length and on its error, in kUnit.
struct Continuous {
  Interval exact, range, dx, dy, dz;
  double norm, error;

  bool bounded() const { return std::isfinite(magnitude(range) + norm + error); }
};

// Returns 1 / k for a constant k other than 0.
inline Continuous inverse_of(const Continuous& k) {
  const Interval one{1, 1}, inverse = one / k.range;
  const double most = magnitude(inverse);
  return {one / k.exact, inverse, {0, 0}, {0, 0}, {0, 0}, k.norm, k.error * most * most};
}

struct Discontinuity {
  // Number of the operation that is not continuous, in the order of evaluation; 0: there is none. Values with the
  // same number are not continuous at the same places, where some operand x passes a value.
  std::uint64_t operation = 0;
  bool pole;  // the value is infinite there
  // Limits as x rises to that value, and as x falls to it: ranges over all such places. Infinite at a pole.
  Interval limits[2];
  Interval step;        // of a jump: the second limit less the first, anywhere
  Interval reach;       // range of the exact values and of those on the way to the f32 values
  Interval dx, dy, dz;  // ranges of the partial derivatives
  // At a value v, the length of the gradient is at most slope + slope_growth (v - m)^2, and the rate at which the
  // error changes v is at most error + error_growth (v - m)^2, in kUnit, for some m in `middle`. Without a pole, the
  // value does not grow, and `middle` is not used.
  Interval middle;
  double slope, slope_growth, error, error_growth;

  Discontinuity() {}
  Discontinuity(const Discontinuity& other) { *this = other; }
  Discontinuity& operator=(const Discontinuity& other) {
    operation = other.operation;
    if (operation == 0) return *this;
    pole = other.pole;
    limits[0] = other.limits[0], limits[1] = other.limits[1], step = other.step, reach = other.reach;
    dx = other.dx, dy = other.dy, dz = other.dz, middle = other.middle;
    slope = other.slope, slope_growth = other.slope_growth;
    error = other.error, error_growth = other.error_growth;
    return *this;
  }

  bool known() const { return operation != 0; }
  bool is_pole() const { return known() && pole; }
  bool is_jump() const { return known() && !pole; }
  // `end`: plus or minus infinity.
  bool tends_to(double end) const { return limits[0].lo == end && limits[1].lo == end; }
  // True if the limits are equal, except for the rounding of doubles, which is far smaller than the step was.
  bool closes() const {
    const double apart = std::max(limits[0].hi - limits[1].lo, limits[1].hi - limits[0].lo);
    return std::isfinite(apart) &&
           apart <= std::min(kRoundings * (magnitude(limits[0]) + magnitude(limits[1])), 0x1p-20 * magnitude(step));
  }
  // True if the step of a jump is a multiple of a period, except for the rounding of doubles.
  bool is_step_multiple_of(Interval period) const {
    const Interval turns = step / period;
    const double whole = round_nearest(Real{turns.lo}).v;
    return std::fabs(whole) < 0x1p20 &&
           std::max(std::fabs(turns.lo - whole), std::fabs(turns.hi - whole)) <= kRoundings * std::fabs(whole);
  }

  static constexpr double kRoundings = 0x1p-48;
};

// Returns the number of a new operation.
inline std::uint64_t number_of_operation() {
  thread_local std::uint64_t count = 0;
  return ++count;
}

// Adds a relative error of `units`, in kUnit, to the bounds: |v| <= |m| + (1 + (v - m)^2) / 2.
inline Discontinuity with_relative_error(Discontinuity d, double units) {
  if (d.is_pole()) {
    d.error += units * rounding(magnitude(d.middle) + 0.5);
    d.error_growth += 0.5 * units;
  } else {
    d.error += units * rounding(magnitude(d.reach));
  }
  if (!std::isfinite(d.slope + d.slope_growth + d.error + d.error_growth)) return {};
  const double share = units * 0x1p-23;
  d.reach = outward(d.reach.lo - share * std::fabs(d.reach.lo), d.reach.hi + share * std::fabs(d.reach.hi));
  return d;
}

// Returns the pole of a / x, where x may be 0.
inline Discontinuity pole_of_quotient(const Continuous& a, double norm_x, double error_x) {
  const double least = std::min(std::fabs(a.range.lo), std::fabs(a.range.hi));
  if (contains(a.range, 0) || !a.bounded() || !std::isfinite(norm_x + error_x)) return {};
  Discontinuity d;
  d.operation = number_of_operation();
  d.pole = true;
  const double end =
      a.range.lo > 0 ? std::numeric_limits<double>::infinity() : -std::numeric_limits<double>::infinity();
  d.limits[0] = {-end, -end}, d.limits[1] = {end, end};
  d.middle = {0, 0};
  d.step = d.reach = d.dx = d.dy = d.dz = whole_line();
  // The gradient is (q grad a - q^2 grad x) / a, for q = a / x.
  d.slope = 0.5 * a.norm / least;
  d.slope_growth = (0.5 * a.norm + norm_x) / least;
  d.error = 0.5 * a.error / least;
  d.error_growth = (0.5 * a.error + error_x) / least;
  return with_relative_error(d, 1);
}

// Returns a jump by `step` between the limits. `away`: the value's bounds away from the jump.
inline Discontinuity jump_between(Interval before, Interval after, Interval step, const Continuous& away) {
  if (!away.bounded()) return {};
  Discontinuity d;
  d.operation = number_of_operation();
  d.pole = false;
  d.limits[0] = before, d.limits[1] = after, d.step = step;
  d.middle = {0, 0};
  d.reach = away.range;
  d.dx = away.dx, d.dy = away.dy, d.dz = away.dz;
  d.slope = away.norm, d.slope_growth = 0;
  d.error = away.error, d.error_growth = 0;
  return d;
}

// Returns the jump of an angle from -pi to pi, where y passes 0 and x is negative. `angle`: as if it did not jump.
inline Discontinuity jump_of_angle(const Continuous& angle) {
  return jump_between(outward(-kPi, -kPi), outward(kPi, kPi), outward(2 * kPi, 2 * kPi), angle);
}

// Returns the jumps of a mod b for a constant b > 0. `error`: bound on the error of f32 if a is exact, except that
// f32 may be before a jump where the exact value is behind it. Functions that close the jump change there by twice as
// much.
inline Discontinuity jumps_of_modulus(const Continuous& a, Interval b, double error) {
  if (!(b.lo > 0) || !a.bounded()) return {};
  Continuous away = a;
  away.range = outward(-error * 0x1p-24, b.hi + error * 0x1p-24);
  away.error += 3 * error;
  return jump_between(b, {0, 0}, -b, away);
}

inline Discontinuity operator-(Discontinuity d) {
  if (!d.known()) return d;
  for (Interval& limit : d.limits) limit = -limit;
  d.step = -d.step;
  d.middle = -d.middle, d.reach = -d.reach;
  d.dx = -d.dx, d.dy = -d.dy, d.dz = -d.dz;
  return d;
}
// Returns the discontinuity of v + u.
inline Discontinuity shifted(Discontinuity d, const Continuous& u) {
  if (!d.known() || !u.bounded()) return {};
  if (!d.is_pole()) {
    for (Interval& limit : d.limits) limit = limit + u.exact;
  }
  d.middle = d.middle + u.range, d.reach = d.reach + u.range;
  d.dx = d.dx + u.dx, d.dy = d.dy + u.dy, d.dz = d.dz + u.dz;
  d.slope += u.norm;
  d.error += u.error;
  return with_relative_error(d, 1);
}
// Returns the discontinuity of k v for a constant k.
inline Discontinuity scaled(Discontinuity d, const Continuous& k) {
  if (!d.known() || k.norm > 0 || contains(k.range, 0) || !k.bounded()) return {};
  if (k.range.hi < 0) d = -d;
  const Interval size = abs(k.range);
  if (!d.is_pole()) {
    for (Interval& limit : d.limits) limit = limit * abs(k.exact);
    d.step = d.step * abs(k.exact);
  }
  d.middle = d.middle * size, d.reach = d.reach * size;
  d.dx = d.dx * size, d.dy = d.dy * size, d.dz = d.dz * size;
  d.slope *= size.hi, d.error *= size.hi;
  d.slope_growth *= size.hi / (size.lo * size.lo), d.error_growth *= size.hi / (size.lo * size.lo);
  return with_relative_error(d, 1 + k.error / size.lo);
}
// Returns the discontinuity of max(v, u), if v is infinite on both sides of a pole.
inline Discontinuity maximum(Discontinuity d, const Continuous& u) {
  if (!d.known() || !d.tends_to(std::numeric_limits<double>::infinity()) || !u.bounded()) return {};
  d.reach = max(d.reach, u.range);
  d.slope = std::max(d.slope, u.norm);
  d.error = std::max(d.error, u.error);
  return d;
}
// Returns the discontinuity of the maximum of two values.
inline Discontinuity maximum(Discontinuity d, const Discontinuity& other) {
  if (!d.known() || d.operation != other.operation) return {};
  for (int side = 0; side < 2; ++side) d.limits[side] = max(d.limits[side], other.limits[side]);
  d.step = d.limits[1] - d.limits[0];
  d.middle = hull(d.middle, other.middle), d.reach = max(d.reach, other.reach);
  d.dx = hull(d.dx, other.dx), d.dy = hull(d.dy, other.dy), d.dz = hull(d.dz, other.dz);
  d.slope = std::max(d.slope, other.slope), d.slope_growth = std::max(d.slope_growth, other.slope_growth);
  d.error = std::max(d.error, other.error), d.error_growth = std::max(d.error_growth, other.error_growth);
  return d;
}

// Returns a bound on e^v / (e^v + e^w) (base + growth (v - m)^2) for all v up to `highest`, w from `least` on and m
// in `middle`.
inline double weighted(Interval middle, double base, double growth, double highest, double least) {
  // Up to `least`, e^(v - w) (v - m)^2 rises with v where |v - m| > 2, and is at most 4 elsewhere. Above, the weight
  // is at most 1.
  const auto away = [&](double v) { return std::max(std::fabs(v - middle.lo), std::fabs(v - middle.hi)); };
  const double first = std::min(highest, least);
  double farthest = std::max(2.0, away(first));
  if (highest > least) farthest = std::max(farthest, away(highest));
  const double share = 1 / (1 + exp(Real{least - first}).v);
  return 2 * share * (base + growth * farthest * farthest);
}

}  // namespace fathom::vm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
