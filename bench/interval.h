// Number types of the independent solver: intervals in double, and intervals with the interval of a derivative. Every
// bound moves outwards by one float64 neighbour after every operation, so exact results lie inside. Shares no code
// with vm/, which the solver judges. Source: Moore, "Interval Analysis", 1966.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace fathom::bench {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Interval {
  double lo, hi;

  Interval(double a) : lo(a), hi(a) {}  // implicit: a number is the interval that holds only itself
  Interval(double a, double b) : lo(a), hi(b) {}

  double middle() const { return lo + (hi - lo) / 2; }
  double width() const { return hi - lo; }
};

// std::nextafter(a, infinity), without the function call.
inline double next_up(double a) {
  if (!(a < kInfinity)) return a;
  if (a == 0) return std::numeric_limits<double>::denorm_min();
  if (a == -kInfinity) return std::numeric_limits<double>::lowest();
  return std::bit_cast<double>(std::bit_cast<std::int64_t>(a) + (a > 0 ? 1 : -1));
}
inline double next_down(double a) { return -next_up(-a); }

// Moves both ends outwards by one float64 neighbour. The whole real line when an end is NaN.
inline Interval outward(double lo, double hi) {
  if (!(lo <= hi)) return {-kInfinity, kInfinity};
  return {next_down(lo), next_up(hi)};
}
inline Interval hull(Interval a, Interval b) { return {std::min(a.lo, b.lo), std::max(a.hi, b.hi)}; }

inline Interval operator-(Interval a) { return {-a.hi, -a.lo}; }
inline Interval operator+(Interval a, Interval b) { return outward(a.lo + b.lo, a.hi + b.hi); }
inline Interval operator-(Interval a, Interval b) { return outward(a.lo - b.hi, a.hi - b.lo); }
inline Interval operator*(Interval a, Interval b) {
  const double p = a.lo * b.lo, q = a.lo * b.hi, r = a.hi * b.lo, s = a.hi * b.hi;
  if (std::isnan(p + q + r + s)) return {-kInfinity, kInfinity};
  return outward(std::min(std::min(p, q), std::min(r, s)), std::max(std::max(p, q), std::max(r, s)));
}
inline Interval operator/(Interval a, Interval b) {
  if (b.lo <= 0 && b.hi >= 0) return {-kInfinity, kInfinity};
  return a * outward(1 / b.hi, 1 / b.lo);
}
inline Interval min(Interval a, Interval b) { return {std::min(a.lo, b.lo), std::min(a.hi, b.hi)}; }
inline Interval max(Interval a, Interval b) { return {std::max(a.lo, b.lo), std::max(a.hi, b.hi)}; }
inline Interval abs(Interval a) {
  if (a.lo >= 0) return a;
  if (a.hi <= 0) return -a;
  return {0, std::max(-a.lo, a.hi)};
}
inline Interval square(Interval a) {
  const Interval m = abs(a);
  return {std::max(0.0, next_down(m.lo * m.lo)), next_up(m.hi * m.hi)};
}
inline Interval sqrt(Interval a) {
  const double lo = std::sqrt(std::max(0.0, a.lo)), hi = std::sqrt(std::max(0.0, a.hi));
  return {std::max(0.0, next_down(lo)), next_up(hi)};
}
inline double lower(Interval a) { return a.lo; }
inline double upper(Interval a) { return a.hi; }

// A value and its derivative with respect to the parameter of a line. If the intervals do not decide a minimum of two
// expressions, its derivative is the hull of both derivatives. Source: Mitchell, "Robust Ray Intersection with
// Interval Arithmetic", 1990.
struct Jet {
  Interval v, d;

  Jet(double a) : v(a), d(0) {}
  Jet(Interval value, Interval derivative) : v(value), d(derivative) {}
};

inline Jet operator-(const Jet& a) { return {-a.v, -a.d}; }
inline Jet operator+(const Jet& a, const Jet& b) { return {a.v + b.v, a.d + b.d}; }
inline Jet operator-(const Jet& a, const Jet& b) { return {a.v - b.v, a.d - b.d}; }
inline Jet min(const Jet& a, const Jet& b) {
  if (a.v.hi < b.v.lo) return a;
  if (b.v.hi < a.v.lo) return b;
  return {min(a.v, b.v), hull(a.d, b.d)};
}
inline Jet max(const Jet& a, const Jet& b) { return -min(-a, -b); }
inline Jet abs(const Jet& a) { return max(a, -a); }
inline Jet square(const Jet& a) { return {square(a.v), Interval(2) * a.v * a.d}; }
inline Jet sqrt(const Jet& a) { return {sqrt(a.v), a.d / (Interval(2) * sqrt(a.v))}; }
inline double lower(const Jet& a) { return a.v.lo; }
inline double upper(const Jet& a) { return a.v.hi; }

}  // namespace fathom::bench
