// Along: ranges of f's value and of its derivative by the line's parameter, along an interval of a line. Root
// isolation needs both: an interval in which the derivative keeps its sign has at most one root. Near a tangency the
// value hardly changes, which the value's range alone shows only for very short intervals. Source: Mitchell, "Robust
// Ray Intersection with Interval Arithmetic", 1990.
//
//     sqrt(t^2 + 1) - 2 over t in [0, 1]:    v [-1, -0.58]   d [0, 0.71]
//
// Like Slope's, the ranges hold where every operation of the program is defined. The derivative's range is unbounded
// where the value may jump.
// Tested by: tests/vm/number/along_test.cpp
#if defined(FATHOM_VM_ALONG_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef FATHOM_VM_ALONG_INL
#undef FATHOM_VM_ALONG_INL
#else
#define FATHOM_VM_ALONG_INL
#endif

#include "vm/number/interval_elementary-inl.h"
#include "vm/number/logarithm-inl.h"

HWY_BEFORE_NAMESPACE();
namespace fathom::vm::HWY_NAMESPACE {

// Ranges of ln u and of its derivative, which a value u made of exponentials keeps (logarithm-inl.h). Copies skip the
// members when not `known`, as for most values.
struct AlongLogarithm {
  bool known = false;
  Interval v, d;

  AlongLogarithm() {}
  AlongLogarithm(Interval range, Interval derivative) : known(true), v(range), d(derivative) {}
  AlongLogarithm(const AlongLogarithm& other) { *this = other; }
  AlongLogarithm& operator=(const AlongLogarithm& other) {
    known = other.known;
    if (known) v = other.v, d = other.d;
    return *this;
  }
};

struct Along {
  using Constant = Along;
  Interval v, d;
  AlongLogarithm logarithm = {};

  static inline Along broadcast(double value) { return {Interval::broadcast(value), {0, 0}}; }
};

// Returns combine(ln a, ln b), if one of the values already has a logarithm.
template <class Combine>
inline AlongLogarithm combined(const Along& a, const Along& b, const Combine& combine) {
  if (!a.logarithm.known && !b.logarithm.known) return {};
  const auto logarithm_of = [](const Along& u) {
    if (u.logarithm.known) return u.logarithm;
    return u.v.lo > 0 ? AlongLogarithm(log(u.v), u.d / u.v) : AlongLogarithm();
  };
  const AlongLogarithm of_a = logarithm_of(a), of_b = logarithm_of(b);
  return of_a.known && of_b.known ? combine(of_a, of_b) : AlongLogarithm();
}

// Returns f(a) with range v, where f's derivative is in `slope`.
inline Along chain(const Along& a, Interval v, Interval slope) { return {v, a.d * slope}; }
inline Along jump(const Along&, Interval v) { return {v, whole_line()}; }
// Returns a value that is a or b and is continuous where the choice changes.
inline Along either(const Along& a, const Along& b, Interval v) { return {v, hull(a.d, b.d)}; }

inline Along operator-(const Along& a) { return {-a.v, -a.d}; }
inline Along operator+(const Along& a, const Along& b) {
  return {a.v + b.v, a.d + b.d, combined(a, b, [](const AlongLogarithm& x, const AlongLogarithm& y) {
            return AlongLogarithm(log_of_sum(x.v, y.v), LogWeight(x.v, y.v).mean(x.d, y.d));
          })};
}
inline Along operator-(const Along& a, const Along& b) { return {a.v - b.v, a.d - b.d}; }
inline Along operator*(const Along& a, const Along& b) {
  return {a.v * b.v, a.v * b.d + b.v * a.d, combined(a, b, [](const AlongLogarithm& x, const AlongLogarithm& y) {
            return is_normal(x.v) && is_normal(y.v) ? AlongLogarithm(x.v + y.v, x.d + y.d) : AlongLogarithm();
          })};
}
inline Along operator/(const Along& a, const Along& b) {
  const AlongLogarithm logarithm = combined(a, b, [](const AlongLogarithm& x, const AlongLogarithm& y) {
    return is_normal(x.v) && is_normal(y.v) ? AlongLogarithm(x.v - y.v, x.d - y.d) : AlongLogarithm();
  });
  if (contains(b.v, 0)) return {whole_line(), whole_line(), logarithm};
  const Interval q = a.v / b.v;
  return {q, (a.d - q * b.d) / b.v, logarithm};
}
inline Along divide(const Along& a, const Along& b) { return a / b; }

inline IntervalMask operator<(const Along& a, const Along& b) { return a.v < b.v; }
inline IntervalMask operator>(const Along& a, const Along& b) { return b < a; }
inline Along select(IntervalMask mask, const Along& yes, const Along& no) {
  if (!mask.maybe_false) return yes;
  if (!mask.maybe_true) return no;
  return either(yes, no, hull(yes.v, no.v));
}
inline Along min(const Along& a, const Along& b) {
  if (a.v.hi < b.v.lo) return a;
  if (b.v.hi < a.v.lo) return b;
  return either(a, b, min(a.v, b.v));
}
inline Along max(const Along& a, const Along& b) {
  if (a.v.hi < b.v.lo) return b;
  if (b.v.hi < a.v.lo) return a;
  return either(a, b, max(a.v, b.v));
}
inline Along abs(const Along& a) {
  return chain(a, abs(a.v), a.v.lo >= 0 ? Interval{1, 1} : a.v.hi <= 0 ? Interval{-1, -1} : Interval{-1, 1});
}
inline Along sqr(const Along& a) { return chain(a, sqr(a.v), a.v + a.v); }
inline Along sqrt(const Along& a) {
  const Interval root = sqrt(a.v);
  return chain(a, root, root.lo > 0 ? Interval{0.5, 0.5} / root : whole_line());
}

// Returns a value in v whose derivative is at most `speed` in magnitude.
inline Along at_most(Interval v, double speed) { return {v, {-speed, speed}}; }
// Returns x dx / l, the term of component x in the derivative of a length l; `inverse` is 1 / l.
inline Interval share(const Along& x, Interval inverse) { return intersect(x.v * inverse, -1, 1) * x.d; }
inline Along length(const Along& x, const Along& y) {
  const Interval l = length(x.v, y.v);
  const double speed = length(x.d, y.d).hi;
  if (!(l.lo > 0)) return at_most(l, speed);
  const Interval inverse = Interval{1, 1} / l;
  return {l, intersect(share(x, inverse) + share(y, inverse), -speed, speed)};
}
inline Along length(const Along& x, const Along& y, const Along& z) {
  const Interval l = length(x.v, y.v, z.v);
  const double speed = length(x.d, y.d, z.d).hi;
  if (!(l.lo > 0)) return at_most(l, speed);
  const Interval inverse = Interval{1, 1} / l;
  return {l, intersect(share(x, inverse) + share(y, inverse) + share(z, inverse), -speed, speed)};
}

inline Along sin(const Along& a) { return chain(a, sin(a.v), cos(a.v)); }
inline Along cos(const Along& a) { return chain(a, cos(a.v), -sin(a.v)); }
inline Along tan(const Along& a) {
  const Interval t = tan(a.v);
  return magnitude(t) < std::numeric_limits<double>::infinity() ? chain(a, t, Interval{1, 1} + sqr(t)) : jump(a, t);
}
// Range of the derivative 1/sqrt(1 - x^2), which is 0 where |x| > 1 and unbounded near 1.
inline Interval asin_rise(Interval x) {
  const Interval one{1, 1}, m = abs(x);
  if (m.lo > 1) return {0, 0};
  if (!(m.hi < 1)) return {0, std::numeric_limits<double>::infinity()};
  return one / sqrt((one - m) * (one + m));
}
inline Along asin(const Along& a) { return chain(a, asin(a.v), asin_rise(a.v)); }
inline Along acos(const Along& a) { return chain(a, acos(a.v), -asin_rise(a.v)); }
inline Along atan(const Along& a) {
  const Interval one{1, 1};
  return chain(a, atan(a.v), one / (one + sqr(a.v)));
}
inline Along atan2(const Along& y, const Along& x) {
  const Interval angle = atan2(y.v, x.v);
  if (contains(y.v, 0) && x.v.lo <= 0) return jump(y, angle);  // the branch cut
  const Interval square = sqr(y.v) + sqr(x.v);
  return {angle, x.v / square * y.d - y.v / square * x.d};
}
inline Along exp(const Along& a) { return {exp(a.v), a.d * exp(a.v), {a.v, a.d}}; }
inline Along log(const Along& a) {
  if (a.logarithm.known && is_normal(a.logarithm.v)) return {a.logarithm.v, a.logarithm.d};
  return a.v.lo > 0 ? chain(a, log(a.v), Interval{1, 1} / a.v) : jump(a, log(a.v));
}
inline Along pow(const Along& x, const Along& y) {
  const Interval v = pow(x.v, y.v);
  const bool fixed = y.d.lo == 0 && y.d.hi == 0 && y.v.hi - y.v.lo < 1e-9;
  const double n = round_nearest(Real{y.v.lo}).v;
  if (fixed && contains(y.v, n) && (n > 0 || !contains(x.v, 0))) {
    return chain(x, v, n == 0 ? Interval{0, 0} : Interval{n, n} * pow(x.v, Interval{n - 1, n - 1}));
  }
  if (x.v.lo > 0) return {v, exp(y * log(x)).d};
  // A power with exponent above 1 has a bounded derivative even at x = 0.
  if (fixed && x.v.lo >= 0 && y.v.lo > 1) return chain(x, v, y.v * pow(x.v, y.v - Interval{1, 1}));
  return jump(x, v);
}

// Value of a step function: constant if there is only one step in the interval.
inline Along steps(const Along& a, Interval v) { return v.lo == v.hi ? Along{v, {0, 0}} : jump(a, v); }
inline Along floor(const Along& a) { return steps(a, floor(a.v)); }
inline Along ceil(const Along& a) { return steps(a, ceil(a.v)); }
inline Along round_nearest(const Along& a) { return steps(a, round_nearest(a.v)); }
inline Along sign(const Along& a) { return steps(a, sign(a.v)); }
inline Along logical_not(const Along& a) { return steps(a, logical_not(a.v)); }
inline Along compare(const Along& a, const Along& b) { return steps(a, compare(a.v, b.v)); }
inline Along step(const Along& edge, const Along& x) { return steps(x, step(edge.v, x.v)); }
inline Along mod(const Along& a, const Along& b) {
  if (contains(b.v, 0)) return {whole_line(), whole_line()};
  const Along turns = floor(a / b);
  return turns.v.lo == turns.v.hi ? a - b * turns : jump(a, mod(a.v, b.v));
}
inline Along logical_and(const Along& a, const Along& b) {
  if (!contains(a.v, 0)) return b;
  if (a.v.lo == a.v.hi) return {{0, 0}, {0, 0}};
  return jump(a, logical_and(a.v, b.v));
}
inline Along logical_or(const Along& a, const Along& b) {
  if (!contains(a.v, 0)) return a;
  if (a.v.lo == a.v.hi) return b;
  return jump(a, logical_or(a.v, b.v));
}

}  // namespace fathom::vm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
