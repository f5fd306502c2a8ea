// Slope: bounds of a formula over a box: the ranges of its value and partial derivatives, the maximum length of its
// gradient, and the maximum difference between f32 evaluation and the exact value. One run of the program gives a
// Lipschitz constant and an error bound of any formula, so a user's expression can be marched like a shape.
//
//     sqrt(x^2 + y^2) - 1 over [-2,2]^2:    v [-1, 1.83]   norm 1   error a few units
//
// The gradient's length is bounded by the partial derivatives and also by rules of its own, such as
// |grad(a + b)| <= |grad a| + |grad b|. A sum of squares s = |F|^2 also keeps J^T J of its components F: grad sqrt(s)
// is J^T F / |F|, no longer than the largest singular value of J, whose square is at most the largest row sum of |J^T
// J| (Gershgorin). So distances have norm 1 even where they are 0 and the quotient of intervals is unbounded.
// A value made of exponentials keeps bounds of its logarithm (logarithm-inl.h), and a value that jumps or is
// infinite somewhere those away from there (discontinuity-inl.h).
//
// Errors are in units of 2^-24: a rounding to f32 adds at most |result|. Running error analysis after Higham,
// "Accuracy and Stability of Numerical Algorithms", 2002, section 3.3: the error of an operation is its operands'
// errors times its slope over all values that f32 may have there (`seen`), plus its own rounding error. A jump that
// f32 may take elsewhere than exact arithmetic counts with its full height, and an f32 operand outside the domain
// makes the error unbounded.
//
// The bounds hold at points where every operation of the program is defined, because a NaN can vanish in a min or a
// comparison.
// Tested by: tests/vm/interpret/formula_test.cpp
#if defined(FATHOM_VM_SLOPE_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef FATHOM_VM_SLOPE_INL
#undef FATHOM_VM_SLOPE_INL
#else
#define FATHOM_VM_SLOPE_INL
#endif

#include <algorithm>
#include <array>

#include "vm/number/interval_elementary-inl.h"
#include "vm/number/logarithm-inl.h"
#include "vm/program/opcode.h"

HWY_BEFORE_NAMESPACE();
namespace fathom::vm::HWY_NAMESPACE {

// Extra bounds of a value that is a sum of squares |F|^2. Copies skip the members when not `known`, as for most
// values.
struct Squares {
  bool known = false;
  std::array<Interval, 6> g;  // J^T J of F: xx yy zz xy xz yz
  double steepest;            // bound on the largest singular value of J: the root of the summed squares of the norms
  double root_error;          // bound on |sqrt(f32 value) - |F||, with an exact sqrt, in kUnit

  Squares() {}
  Squares(const Squares& other) { *this = other; }
  Squares& operator=(const Squares& other) {
    known = other.known;
    if (known) g = other.g, steepest = other.steepest, root_error = other.root_error;
    return *this;
  }
};

struct Slope {
  using Constant = Slope;
  Interval v;           // range of the exact value
  Interval dx, dy, dz;  // ranges of the partial derivatives, where these exist
  double norm;          // bound on the gradient's length; infinite where the value may jump
  // Bounds on exact value - f32 value and on f32 value - exact value, in kUnit. If only `above` is infinite, the f32
  // value may be infinite, and if only `below` is, minus infinity. If both are infinite, it may be NaN.
  double below, above;
  bool nonnegative;  // true if neither the exact nor the f32 value can be negative
  Squares squares = {};
  Logarithm logarithm = {};
  Discontinuity discontinuity = {};

  double error() const { return std::max(below, above); }  // bound on |f32 value - exact value|, in kUnit

  static inline Slope broadcast(double value);
};

// Returns the range of the f32 value.
inline Interval seen(const Slope& a) {
  const Interval range = outward(a.v.lo - bound(a.below * kUnit), a.v.hi + bound(a.above * kUnit));
  return a.nonnegative ? Interval{std::max(0.0, range.lo), std::max(0.0, range.hi)} : range;
}

// Returns the bound on exact value - rounded f32 value, or the reverse, given the bound before the rounding, for a
// value in v. Rounding is monotonic, so values on the other side of the exact one do not count.
inline double rounded_below(Interval v, double below) {
  return below + rounding(magnitude(outward(v.lo - bound(below * kUnit), v.hi)));
}
inline double rounded_above(Interval v, double above) {
  return above + rounding(magnitude(outward(v.lo, v.hi + bound(above * kUnit))));
}

inline Slope make_slope(Interval v, Interval dx, Interval dy, Interval dz, double norm, double below, double above) {
  const double mx = magnitude(dx), my = magnitude(dy), mz = magnitude(dz);
  const double length = bound(std::sqrt(mx * mx + my * my + mz * mz));
  const double n = std::min(bound(norm), length);
  return {v, intersect(dx, -n, n), intersect(dy, -n, n), intersect(dz, -n, n), n, bound(below), bound(above), false};
}
inline Slope make_slope(Interval v, Interval dx, Interval dy, Interval dz, double norm, double error) {
  return make_slope(v, dx, dy, dz, norm, error, error);
}
// Returns f(a) with range v, where f's derivative is in `slope` over a's exact values.
inline Slope chain(const Slope& a, Interval v, Interval slope, double below, double above) {
  return make_slope(v, a.dx * slope, a.dy * slope, a.dz * slope, times(a.norm, magnitude(slope)), below, above);
}
inline Slope chain(const Slope& a, Interval v, Interval slope, double error) {
  return chain(a, v, slope, error, error);
}
// Returns a value in v with unbounded derivatives, whose f32 value is in v or `alternatives`.
inline Slope jump(Interval v, Interval alternatives) {
  const Interval all = hull(v, alternatives), line = whole_line();
  Slope result = make_slope(v, line, line, line, kUnbounded, (all.hi - all.lo) / kUnit + rounding(magnitude(all)));
  result.nonnegative = all.lo >= 0;
  return result;
}
inline Slope exactly(Interval v) {
  Slope result = make_slope(v, {0, 0}, {0, 0}, {0, 0}, 0, 0);
  result.nonnegative = result.squares.known = v.lo >= 0;
  if (result.squares.known) {
    result.squares.g = {};
    result.squares.steepest = 0;
    result.squares.root_error = bound(magnitude(sqrt(v)) + 0x1p-50);
  }
  return result;
}
inline Slope Slope::broadcast(double value) {
  Slope result = exactly(Interval::broadcast(value));
  const bool is_float = static_cast<double>(static_cast<float>(value)) == value;
  if (!is_float) result.below = result.above = rounding(std::fabs(value));
  return result;
}

// Returns bounds of ln a, also for a value that has only the usual bounds.
inline Logarithm logarithm_of(const Slope& a) {
  if (a.logarithm.known) return a.logarithm;
  const double least = std::min(a.v.lo, seen(a).lo);
  if (!(least > 0)) return {};
  return make_logarithm(log(a.v), a.dx / a.v, a.dy / a.v, a.dz / a.v, a.norm / a.v.lo, a.below / least,
                        a.above / least, 0);
}
// Returns combine(ln a, ln b), if one of the values already has a logarithm. Values without one seldom gain by it.
template <class Combine>
inline Logarithm combined(const Slope& a, const Slope& b, const Combine& combine) {
  if (!a.logarithm.known && !b.logarithm.known) return {};
  const Logarithm of_a = logarithm_of(a), of_b = logarithm_of(b);
  return of_a.known && of_b.known ? combine(of_a, of_b) : Logarithm();
}

inline Continuous continuous(const Slope& a) {
  return {a.v, hull(a.v, seen(a)), a.dx, a.dy, a.dz, a.norm, a.error()};
}
// Returns -a, as far as operator-() of discontinuities needs it.
inline Continuous negated(Continuous a) { return {-a.exact, -a.range, -a.dx, -a.dy, -a.dz, a.norm, a.error}; }
// True if exactly one of two operands has a discontinuity.
inline bool one_breaks(const Slope& a, const Slope& b) { return a.discontinuity.known() != b.discontinuity.known(); }
inline Discontinuity larger(const Slope& a, const Slope& b) {
  const Discontinuity &of_a = a.discontinuity, &of_b = b.discontinuity;
  if (of_a.known() && of_b.known()) return maximum(of_a, of_b);
  return of_a.known() ? maximum(of_a, continuous(b)) : maximum(of_b, continuous(a));
}
inline Discontinuity smaller(const Slope& a, const Slope& b) {
  const Discontinuity &of_a = a.discontinuity, &of_b = b.discontinuity;
  if (of_a.known() && of_b.known()) return -maximum(-of_a, -of_b);
  return of_a.known() ? -maximum(-of_a, negated(continuous(b))) : -maximum(-of_b, negated(continuous(a)));
}

inline Slope operator-(const Slope& a) {
  Slope r = make_slope(-a.v, -a.dx, -a.dy, -a.dz, a.norm, a.above, a.below);
  r.discontinuity = -a.discontinuity;
  return r;
}
inline Slope operator+(const Slope& a, const Slope& b) {
  const Interval sum = seen(a) + seen(b);
  Slope r = make_slope(a.v + b.v, a.dx + b.dx, a.dy + b.dy, a.dz + b.dz, a.norm + b.norm,
                       rounded_below(a.v + b.v, a.below + b.below), rounded_above(a.v + b.v, a.above + b.above));
  r.nonnegative = a.nonnegative && b.nonnegative;
  r.squares.known = a.squares.known && b.squares.known;
  if (r.squares.known) {
    for (std::size_t i = 0; i < 6; ++i) r.squares.g[i] = a.squares.g[i] + b.squares.g[i];
    r.squares.steepest = bound(length_of(a.squares.steepest, b.squares.steepest));
    // The roots of a and b are the lengths of two parts of F, so their errors add up like lengths.
    r.squares.root_error = bound(length_of(a.squares.root_error, b.squares.root_error) + magnitude(sqrt(sum)));
  }
  r.logarithm = combined(a, b, log_sum);
  if (one_breaks(a, b)) {
    r.discontinuity =
        a.discontinuity.known() ? shifted(a.discontinuity, continuous(b)) : shifted(b.discontinuity, continuous(a));
  }
  return r;
}
inline Slope operator-(const Slope& a, const Slope& b) {
  Slope r = make_slope(a.v - b.v, a.dx - b.dx, a.dy - b.dy, a.dz - b.dz, a.norm + b.norm,
                       rounded_below(a.v - b.v, a.below + b.above), rounded_above(a.v - b.v, a.above + b.below));
  if (one_breaks(a, b)) {
    r.discontinuity = a.discontinuity.known() ? shifted(a.discontinuity, negated(continuous(b)))
                                              : shifted(-b.discontinuity, continuous(a));
  }
  return r;
}
// Returns a b, given the errors of f32.
inline Slope product(const Slope& a, const Slope& b, double below, double above) {
  const double ma = magnitude(a.v), mb = magnitude(b.v);
  Slope r = make_slope(a.v * b.v, a.v * b.dx + b.v * a.dx, a.v * b.dy + b.v * a.dy, a.v * b.dz + b.v * a.dz,
                       times(ma, b.norm) + times(mb, a.norm), below, above);
  r.nonnegative = a.nonnegative && b.nonnegative;
  r.logarithm = combined(a, b, log_product);
  if (one_breaks(a, b)) {
    r.discontinuity =
        a.discontinuity.known() ? scaled(a.discontinuity, continuous(b)) : scaled(b.discontinuity, continuous(a));
  }
  return r;
}
// Returns a b where a's f32 value A may be infinite. For an f32 factor B > 0, A >= a - below makes A B at least
// a b - |a| |B - b| - B below.
inline Slope scaled(const Slope& a, const Slope& b) {
  const Interval s = seen(b), v = a.v * b.v;
  if (contains(s, 0)) return product(a, b, kUnbounded, kUnbounded);
  const double most = magnitude(s), own = times(magnitude(a.v), b.error());
  const bool flips = s.hi < 0;
  return product(a, b, rounded_below(v, most * (flips ? a.above : a.below) + own),
                 rounded_above(v, most * (flips ? a.below : a.above) + own));
}
inline Slope operator*(const Slope& a, const Slope& b) {
  if (!(a.error() < kUnbounded) && b.error() < kUnbounded) return scaled(a, b);
  if (!(b.error() < kUnbounded) && a.error() < kUnbounded) return scaled(b, a);
  const Interval seen_a = seen(a);
  const double error =
      times(magnitude(seen_a), b.error()) + times(magnitude(b.v), a.error()) + rounding(magnitude(seen_a * seen(b)));
  return product(a, b, error, error);
}
inline Slope operator/(const Slope& a, const Slope& b) {
  const Interval sb = seen(b);
  if (contains(sb, 0)) {
    Slope r = jump(whole_line(), whole_line());
    r.logarithm = combined(a, b, log_quotient);
    r.discontinuity = pole_of_quotient(continuous(a), b.norm, b.error());
    return r;
  }
  const Interval q = a.v / b.v, inverse = Interval{1, 1} / b.v;
  const double smallest = std::min(std::fabs(sb.lo), std::fabs(sb.hi)), m = magnitude(inverse);
  const double own = times(magnitude(q), b.error());
  const bool flips = sb.hi < 0;
  Slope r = make_slope(q, (a.dx - q * b.dx) * inverse, (a.dy - q * b.dy) * inverse, (a.dz - q * b.dz) * inverse,
                       times(a.norm + times(magnitude(q), b.norm), m),
                       rounded_below(q, ((flips ? a.above : a.below) + own) / smallest),
                       rounded_above(q, ((flips ? a.below : a.above) + own) / smallest));
  r.nonnegative = a.nonnegative && b.nonnegative;
  r.logarithm = combined(a, b, log_quotient);
  if (a.discontinuity.known()) r.discontinuity = scaled(a.discontinuity, inverse_of(continuous(b)));
  return r;
}
inline Slope divide(const Slope& a, const Slope& b) { return a / b; }

// Compares the ranges of the f32 values, so no f32 rounding can change a decided comparison.
inline IntervalMask operator<(const Slope& a, const Slope& b) { return seen(a) < seen(b); }
inline IntervalMask operator>(const Slope& a, const Slope& b) { return b < a; }

// Returns a value that is a or b and is continuous where the choice changes.
inline Slope either(const Slope& a, const Slope& b, Interval v, double below, double above) {
  Slope r =
      make_slope(v, hull(a.dx, b.dx), hull(a.dy, b.dy), hull(a.dz, b.dz), std::max(a.norm, b.norm), below, above);
  r.nonnegative = a.nonnegative && b.nonnegative;
  return r;
}
// Assumes that the selected function is continuous. If f32 may take the other branch, the error is the maximum
// difference of the branches in the box.
inline Slope select(IntervalMask mask, const Slope& yes, const Slope& no) {
  if (!mask.maybe_false) return yes;
  if (!mask.maybe_true) return no;
  const double error = magnitude(seen(yes) - seen(no)) / kUnit;
  return either(yes, no, hull(yes.v, no.v), error, error);
}
inline bool maybe_nan(const Slope& a) { return !(a.below < kUnbounded || a.above < kUnbounded); }
inline Slope min(const Slope& a, const Slope& b) {
  const Interval seen_a = seen(a), seen_b = seen(b), v = min(a.v, b.v);
  if (seen_a.hi < seen_b.lo) return a;
  if (seen_b.hi < seen_a.lo) return b;
  const double most =
      maybe_nan(a) || maybe_nan(b) ? kUnbounded : bound((std::min(seen_a.hi, seen_b.hi) - v.lo) / kUnit);
  Slope r = either(a, b, v, std::max(a.below, b.below), std::min(std::max(a.above, b.above), most));
  if (a.discontinuity.known() || b.discontinuity.known()) r.discontinuity = smaller(a, b);
  return r;
}
inline Slope max(const Slope& a, const Slope& b) {
  const Interval seen_a = seen(a), seen_b = seen(b), v = max(a.v, b.v);
  if (seen_a.hi < seen_b.lo) return b;
  if (seen_b.hi < seen_a.lo) return a;
  const double most =
      maybe_nan(a) || maybe_nan(b) ? kUnbounded : bound((v.hi - std::max(seen_a.lo, seen_b.lo)) / kUnit);
  Slope r = either(a, b, v, std::min(std::max(a.below, b.below), most), std::max(a.above, b.above));
  r.nonnegative = a.nonnegative || b.nonnegative;
  if (a.discontinuity.known() || b.discontinuity.known()) r.discontinuity = larger(a, b);
  return r;
}
// True if a jumps and f(a) does not.
template <class Function>
inline bool closes_jump(const Slope& a, const Function& f) {
  Discontinuity d = a.discontinuity;
  if (!d.is_jump()) return false;
  for (Interval& limit : d.limits) limit = f(limit);
  return d.closes();
}
// Returns the bounds of a away from its jumps.
inline Slope without_jump(const Slope& a) {
  const Discontinuity& d = a.discontinuity;
  return make_slope(a.v, d.dx, d.dy, d.dz, d.slope, d.error);
}
inline Slope abs(const Slope& a) {
  if (closes_jump(a, [](Interval limit) { return abs(limit); })) return abs(without_jump(a));
  const Interval s = seen(a);
  const Interval slope = s.lo >= 0 ? Interval{1, 1} : s.hi <= 0 ? Interval{-1, -1} : Interval{-1, 1};
  Slope r = chain(a, abs(a.v), slope, s.lo >= 0 ? a.below : a.error(), s.lo >= 0 ? a.above : a.error());
  r.nonnegative = true;
  if (a.discontinuity.is_pole()) {
    r.discontinuity = maximum(a.discontinuity, -a.discontinuity);
    r.discontinuity.reach = abs(a.discontinuity.reach);
  }
  return r;
}
inline Slope sqr(const Slope& a) {
  if (closes_jump(a, [](Interval limit) { return sqr(limit); })) return sqr(without_jump(a));
  const Interval seen_a = seen(a);
  const double error = times(magnitude(seen_a) + magnitude(a.v), a.error()) + rounding(magnitude(sqr(seen_a)));
  Slope r = chain(a, sqr(a.v), a.v + a.v, error);
  r.nonnegative = r.squares.known = true;
  r.squares.steepest = a.norm;
  r.squares.g = {sqr(a.dx), sqr(a.dy), sqr(a.dz), a.dx * a.dy, a.dx * a.dz, a.dy * a.dz};
  // The root of the square is |a|, except for the square's rounding, whose relative error is halved by the root, and
  // underflow (below 2^-150, so the root is off by at most 2^-74).
  r.squares.root_error = bound(a.error() + magnitude(seen_a) + 0x1p-50);
  return r;
}
// Returns a bound on the largest singular value of J, where g is J^T J.
inline double gram_norm(const std::array<Interval, 6>& g) {
  double m[6];
  for (std::size_t i = 0; i < 6; ++i) m[i] = magnitude(g[i]);
  return bound(std::sqrt(std::max({m[0] + m[3] + m[4], m[1] + m[3] + m[5], m[2] + m[4] + m[5]})));
}
inline double largest_singular(const Squares& squares) { return std::min(gram_norm(squares.g), squares.steepest); }
inline Slope sqrt(const Slope& a) {
  const Interval s = seen(a), root = sqrt(a.v), line = whole_line();
  if (!(s.lo >= 0)) {  // the f32 operand may be negative, and the f32 root NaN
    Slope r = jump(root, root);
    r.below = r.above = kUnbounded;
    return r;
  }
  // |sqrt(a + e) - sqrt(a)| is at most sqrt(e), and at most e divided by the sum of the roots.
  const double apart = std::sqrt(s.lo) + std::sqrt(std::max(0.0, a.v.lo));
  const double error = std::min({apart > 0 ? a.error() / apart : kUnbounded, std::sqrt(a.error() / kUnit),
                                 a.squares.known ? a.squares.root_error : kUnbounded});
  const Interval slope = root.lo > 0 ? Interval{0.5, 0.5} / root : line;
  const double norm =
      std::min(times(a.norm, magnitude(slope)), a.squares.known ? largest_singular(a.squares) : kUnbounded);
  Slope r = make_slope(root, a.dx * slope, a.dy * slope, a.dz * slope, norm, 0);
  if (!(r.norm <= norm)) r.norm = norm;
  r.below = r.above = bound(error + rounding(magnitude(sqrt(s))));
  r.nonnegative = true;
  return r;
}
inline Slope length(const Slope& x, const Slope& y) { return sqrt(sqr(x) + sqr(y)); }
inline Slope length(const Slope& x, const Slope& y, const Slope& z) { return sqrt(sqr(x) + sqr(y) + sqr(z)); }

// Returns the distance d of a shape at p. The distance has Lipschitz constant 1 in p and the float error that
// vm/program/opcodes.def promises. The Lipschitz constant of the result is the largest singular value of p's
// derivatives, because the direction in which p moves is unknown.
inline Slope distance_at(const Vec3<Slope>& p, Interval d) {
  const Slope squares = sqr(p.x) + sqr(p.y) + sqr(p.z);
  const double speed = gram_norm(squares.squares.g);
  const Interval all{-speed, speed};
  const double moved = length(seen(p.x) - p.x.v, seen(p.y) - p.y.v, seen(p.z) - p.z.v).hi;
  const double scale = std::max({1.0, magnitude(seen(sqrt(squares))), magnitude(d) + moved});
  const double carried = std::sqrt(p.x.error() * p.x.error() + p.y.error() * p.y.error() + p.z.error() * p.z.error());
  return make_slope(d, all, all, all, speed, carried + kFloatError / kUnit * scale);
}

}  // namespace fathom::vm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
