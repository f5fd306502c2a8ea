// Pole: bounds of a value near a pole, i.e. over a box in which a divisor x may be 0, kept by Slope (slope-inl.h).
// The value is c / x, or c / x plus, scaled by or compared with values that have bounds. Its slope has no bound, but
// grows no faster than the square of the value, because the slope of c / x is (c / x)^2 / c. An exponential that
// falls outweighs a square, so a union of exponentials such as -ln(exp(-k a) + exp(-k max(c / x, b))) has a bound
// where c / x tends to infinity on both sides of the pole.
//
// Errors count as paths from the exact value to the f32 value. An error of x moves c / x along its graph, perhaps
// through the pole, and so changes the value at a rate that the square of the value bounds, too.
// Tested by: tests/vm/interpret/formula_test.cpp
#if defined(FATHOM_VM_POLE_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef FATHOM_VM_POLE_INL
#undef FATHOM_VM_POLE_INL
#else
#define FATHOM_VM_POLE_INL
#endif

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "vm/number/interval_elementary-inl.h"

HWY_BEFORE_NAMESPACE();
namespace fathom::vm::HWY_NAMESPACE {

struct Pole {
  std::uint64_t division = 0;  // number of the division by x, in the order of evaluation; 0: the value has no pole
  // Sign of the infinity that the value tends to as x rises to 0, and as x falls to 0.
  int ends[2];
  // At a value v, the length of the gradient is at most slope + slope_growth (v - m)^2, and the rate at which the
  // error changes v is at most error + error_growth (v - m)^2, in kUnit, for some m in `middle`.
  Interval middle;
  Interval reach;  // range of the exact values and of those on the way to the f32 values
  double slope, slope_growth, error, error_growth;

  Pole() {}
  Pole(const Pole& other) { *this = other; }
  Pole& operator=(const Pole& other) {
    division = other.division;
    if (division == 0) return *this;
    ends[0] = other.ends[0], ends[1] = other.ends[1], middle = other.middle, reach = other.reach;
    slope = other.slope, slope_growth = other.slope_growth;
    error = other.error, error_growth = other.error_growth;
    return *this;
  }

  bool known() const { return division != 0; }
  bool tends_to(int end) const { return ends[0] == end && ends[1] == end; }
};

// Returns the number of a new division.
inline std::uint64_t number_of_division() {
  thread_local std::uint64_t count = 0;
  return ++count;
}

// Adds a relative error of `units`, in 2^-24, to the bounds: |v| <= |m| + (1 + (v - m)^2) / 2.
inline Pole with_relative_error(Pole p, double units) {
  const double share = units * 0x1p-23;
  p.reach = outward(p.reach.lo - share * std::fabs(p.reach.lo), p.reach.hi + share * std::fabs(p.reach.hi));
  p.error += units * (magnitude(p.middle) + 0.5);
  p.error_growth += 0.5 * units;
  return p;
}

// Returns the pole of a / x, where a has one sign. `norm`, `error`: bounds on the gradients' lengths and on the
// errors, in kUnit.
inline Pole pole_of_quotient(Interval a, double norm_a, double error_a, double norm_x, double error_x) {
  const double least = std::min(std::fabs(a.lo), std::fabs(a.hi));
  if (!(a.lo > 0 || a.hi < 0) || !std::isfinite(norm_a + error_a + norm_x + error_x)) return {};
  Pole p;
  p.division = number_of_division();
  p.ends[0] = a.lo > 0 ? -1 : 1;
  p.ends[1] = -p.ends[0];
  p.middle = {0, 0};
  p.reach = whole_line();
  // The gradient is (q grad a - q^2 grad x) / a, for q = a / x.
  p.slope = 0.5 * norm_a / least;
  p.slope_growth = (0.5 * norm_a + norm_x) / least;
  p.error = 0.5 * error_a / least;
  p.error_growth = (0.5 * error_a + error_x) / least;
  return with_relative_error(p, 1);
}

inline Pole operator-(Pole p) {
  if (!p.known()) return p;
  p.ends[0] = -p.ends[0], p.ends[1] = -p.ends[1];
  p.middle = -p.middle;
  p.reach = -p.reach;
  return p;
}
// Returns the pole of v + u, for a value u with the range `other` of its exact and f32 values.
inline Pole shifted(Pole p, Interval other, double norm, double error) {
  if (!p.known() || !std::isfinite(magnitude(other) + norm + error)) return {};
  p.middle = p.middle + other;
  p.reach = p.reach + other;
  p.slope += norm;
  p.error += error;
  return with_relative_error(p, 1);
}
// Returns the pole of k v for a constant k.
inline Pole scaled(Pole p, Interval k, double error) {
  const double least = std::min(std::fabs(k.lo), std::fabs(k.hi)), most = magnitude(k);
  if (!p.known() || !(k.lo > 0 || k.hi < 0) || !std::isfinite(most + error)) return {};
  if (k.hi < 0) p = -p;
  p.middle = p.middle * abs(k);
  p.reach = p.reach * abs(k);
  p.slope *= most, p.error *= most;
  p.slope_growth *= most / (least * least), p.error_growth *= most / (least * least);
  return with_relative_error(p, 1 + error / least);
}
// Returns the pole of max(v, u), for a value u without a pole.
inline Pole maximum(Pole p, Interval other, double norm, double error) {
  if (!p.known() || !p.tends_to(1) || !std::isfinite(magnitude(other) + norm + error)) return {};
  p.reach = max(p.reach, other);
  p.slope = std::max(p.slope, norm);
  p.error = std::max(p.error, error);
  return p;
}
inline Pole maximum(Pole p, const Pole& q) {
  if (!p.known() || p.division != q.division) return {};
  for (int side = 0; side < 2; ++side) p.ends[side] = std::max(p.ends[side], q.ends[side]);
  p.middle = hull(p.middle, q.middle);
  p.reach = max(p.reach, q.reach);
  p.slope = std::max(p.slope, q.slope), p.slope_growth = std::max(p.slope_growth, q.slope_growth);
  p.error = std::max(p.error, q.error), p.error_growth = std::max(p.error_growth, q.error_growth);
  return p;
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
