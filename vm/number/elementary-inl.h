// Elementary functions of Batch and RealBatch (f32 and double lanes) and Real (one double), composed of additions,
// multiplications, divisions and square roots only. So they give the same bits on every machine, unlike libm. All
// types share one kernel per function; Precision<N> holds the differences: the number of terms, and the number of
// parts into which pi/2 and ln 2 are split.
//
// Arguments are reduced after Cody & Waite, "Software Manual for the Elementary Functions", 1980: x - n c with c in
// parts so short that n times each part is exact. The reduced argument goes into a Taylor polynomial (sine, cosine,
// exponential; Abramowitz & Stegun, "Handbook of Mathematical Functions", 1964, 4.3.65, 4.3.66, 4.2.1), or into a
// polynomial through the Chebyshev points of the reduced range (arc functions, computed with 60 digits). The rounding
// error of a reduction is added back to first order.
//
// Error bounds checked by the tests: 4 ulp in f32, 1e-14 (relative) in double; pow has its own. sin, cos and tan keep
// these bounds for |x| <= 1e4 (f32) or 1e6 (double). Beyond, the error of the reduction grows in proportion to x, and
// from kNoAngle on x counts as 0. sin, cos and tan of a finite x are never NaN.
//
// Tested by: tests/vm/number/elementary_test.cpp
#if defined(FATHOM_VM_ELEMENTARY_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef FATHOM_VM_ELEMENTARY_INL
#undef FATHOM_VM_ELEMENTARY_INL
#else
#define FATHOM_VM_ELEMENTARY_INL
#endif

#include <cstddef>
#include <limits>

#include "vm/number/batch-inl.h"
#include "vm/number/real-inl.h"

HWY_BEFORE_NAMESPACE();
namespace fathom::vm::HWY_NAMESPACE {

// Constants that differ from type to type. The kernels are templates over the types with a Precision, the Plain ones;
// other number types build on Plain types.
template <class N>
struct Precision;
template <class N>
concept Plain = requires { Precision<N>::kNoAngle; };

template <>
struct Precision<Batch> {
  // Eleven bits per part except the last, so the product of a part and n is exact for n up to 2^13.
  static constexpr double kHalfPi[] = {0x1.92p+0, 0x1.fb4p-12, 0x1.444p-24, 0x1.68c234c4c6629p-39};
  static constexpr double kLn2[] = {0x1.62e4p-1, 0x1.7f7d1cf79abcap-20};
  static constexpr double kNoAngle = 0x1p22;
  static constexpr double kExpLimit = 110;  // e^x is 0 or infinite beyond this |x|
  static constexpr double kPi[] = {3.1415927410125732, -8.742278000372485e-08};
  static constexpr double kInfinity = std::numeric_limits<float>::infinity();
  static constexpr double kWholeFrom = 0x1p24;  // every number from here on is an even integer
  static constexpr int kSineTerms = 4, kCosineTerms = 4, kExpTerms = 6, kLogTerms = 5;
  // Polynomials in s^2: (atan(s)/s - 1)/s^2 for s^2 <= (sqrt 2 - 1)^2, with an error of 3e-9 relative to atan, and
  // (asin(s)/s - 1)/s^2 for s^2 <= 1/4.
  static constexpr double kAtan[] = {-0.3333333134651184, 0.19999539852142334, -0.14263950288295746,
                                     0.10743668675422668, -0.06451718509197235};
  static constexpr double kAsin[] = {0.1666666567325592,   0.07500094175338745,  0.04459940269589424,
                                     0.031100662425160408, 0.017149237915873528, 0.03369084745645523};
};

template <>
struct Precision<Real> {
  // 33 bits per part except the last, so the product of a part and n is exact for n up to 2^20.
  static constexpr double kHalfPi[] = {0x1.921fb544p+0, 0x1.0b4611a6p-34, 0x1.3198a2ep-69, 0x1.b839a252049c1p-104};
  static constexpr double kLn2[] = {0x1.62e42fefa38p-1, 0x1.ef35793c7673p-45};
  static constexpr double kNoAngle = 0x1p48;
  static constexpr double kExpLimit = 760;
  static constexpr double kPi[] = {3.141592653589793, 1.2246467991473532e-16};
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
  static constexpr double kWholeFrom = 0x1p53;
  static constexpr int kSineTerms = 8, kCosineTerms = 8, kExpTerms = 13, kLogTerms = 11;
  // Polynomials as above, with errors of 3e-18 and 5e-18.
  static constexpr double kAtan[] = {-0.3333333333333333,  0.19999999999999804,  -0.14285714285659779,
                                     0.11111111105150588,  -0.09090908753259112, 0.07692296368042296,
                                     -0.0666642476020052,  0.05878927554473807,  -0.05230443640686948,
                                     0.045515447340221615, -0.03456931506332609, 0.016284375050043393};
  static constexpr double kAsin[] = {
      0.16666666666666669,  0.07499999999998433,   0.04464285714635543,  0.030381944138531247, 0.02237217294214989,
      0.017352392720869973, 0.013971212973552933,  0.011479177415184906, 0.01032281435018578,  0.005457506718640358,
      0.01740087944269402,  -0.014851887071247204, 0.028757851367421566};
};

template <>
struct Precision<RealBatch> : Precision<Real> {};

// Returns c[0] + c[1] x + c[2] x^2 + ..., by Horner's rule.
template <Plain N, std::size_t kCount>
HWY_INLINE N polynomial(N x, const double (&c)[kCount]) {
  N sum = N::broadcast(c[kCount - 1]);
  for (std::size_t i = kCount - 1; i-- > 0;) sum = sum * x + N::broadcast(c[i]);
  return sum;
}

// Coefficients 1/first!, sign/(first + by)!, 1/(first + 2 by)!, ... of a Taylor series. Constants, because g++ 12
// divides at run time where they are expressions of a loop.
template <int kTerms>
struct Taylor {
  double c[kTerms];

  constexpr Taylor(int first, int by, double sign) : c{} {
    double factorial = 1;
    for (int i = 1, term = 0; term < kTerms; ++i) {
      factorial *= i;
      if (i == first + by * term) c[term] = (term % 2 == 0 ? 1 : sign) / factorial, ++term;
    }
  }
};
template <class P>
inline constexpr Taylor<P::kSineTerms> kSine{3, 2, -1};
template <class P>
inline constexpr Taylor<P::kCosineTerms> kCosine{4, 2, -1};
template <class P>
inline constexpr Taylor<P::kExpTerms - 1> kExp{2, 1, 1};

// Returns NaN where a or b is NaN, else `value`.
template <Plain N>
HWY_INLINE N nan_from(N a, N b, N value) {
  return select(is_nan(a), a, select(is_nan(b), b, value));
}
template <Plain N>
HWY_INLINE N clamp(N x, double limit) {
  return max(N::broadcast(-limit), min(N::broadcast(limit), x));  // a NaN stays
}

// Returns -1 or 1, or `a` itself where a is zero or NaN.
template <Plain N>
HWY_INLINE N sign(N a) {
  const N zero = N::broadcast(0.0), one = N::broadcast(1.0);
  return select(zero < a, one, select(a < zero, -one, a));
}
// Floored modulo: the result has b's sign, except that rounding can put it just beyond either end. NaN where b is 0.
template <Plain N>
HWY_INLINE N mod(N a, N b) {
  return a - b * floor(a / b);
}
template <class T>
HWY_INLINE T divide(const T& a, const T& b) {
  return a / b;
}
template <Plain N>
HWY_INLINE N logical_not(N a) {
  const N zero = N::broadcast(0.0);
  return select(a < zero, zero, select(zero < a, zero, nan_from(a, a, N::broadcast(1.0))));
}
template <Plain N>
HWY_INLINE N compare(N a, N b) {
  const N zero = N::broadcast(0.0), one = N::broadcast(1.0);
  return select(a < b, -one, select(b < a, one, nan_from(a, b, zero)));
}
// Returns b where a is not 0, else a.
template <Plain N>
HWY_INLINE N logical_and(N a, N b) {
  const N zero = N::broadcast(0.0);
  return select(a < zero, b, select(zero < a, b, a));
}
template <Plain N>
HWY_INLINE N logical_or(N a, N b) {
  const N zero = N::broadcast(0.0);
  return select(a < zero, a, select(zero < a, a, nan_from(a, a, b)));
}
template <Plain N>
HWY_INLINE N step(N edge, N x) {
  return select(x < edge, N::broadcast(0.0), nan_from(edge, x, N::broadcast(1.0)));
}

template <class N>
struct SinCos {
  N sin, cos;
};

// An angle x reduced to r = x - n pi/2 = high + low, where n is the nearest integer to x / (pi/2). |r| exceeds pi/4
// at most slightly.
template <Plain N>
struct Quarter {
  N high, low;
  N number;  // n modulo 4: 0, 1, 2 or 3
};
template <Plain N>
HWY_INLINE Quarter<N> quarter_turns(N angle) {
  using P = Precision<N>;
  const N x = select(abs(angle) < N::broadcast(P::kNoAngle), angle, angle * N::broadcast(0.0));
  const N n = round_nearest(x * N::broadcast(0.63661977236758134308));
  const N a = x - n * N::broadcast(P::kHalfPi[0]) - n * N::broadcast(P::kHalfPi[1]);
  const N t = n * N::broadcast(P::kHalfPi[2]);
  const N b = a - t;
  const N rest = ((a - b) - t) - n * N::broadcast(P::kHalfPi[3]);
  const N high = b + rest;
  const N low = (b - high) + rest;
  // The clamp matters only where x is too large to be reduced exactly.
  return {clamp(high, 0.8), low, n - N::broadcast(4.0) * floor(n * N::broadcast(0.25))};
}

// Returns sine and cosine of q.high + q.low.
template <Plain N>
HWY_INLINE SinCos<N> sin_cos_reduced(const Quarter<N>& q) {
  using P = Precision<N>;
  const N r = q.high, z = r * r, one = N::broadcast(1.0);
  const N half_z = z * N::broadcast(0.5), c = one - half_z;
  const N sine = -polynomial(z, kSine<P>.c);
  const N cosine = polynomial(z, kCosine<P>.c);
  return {r + (r * (z * sine) + q.low * c), c + (((one - c) - half_z) + (z * z * cosine - r * q.low))};
}

template <Plain N>
HWY_INLINE SinCos<N> sin_cos(N x) {
  const Quarter<N> q = quarter_turns(x);
  const SinCos<N> r = sin_cos_reduced(q);
  const N one = N::broadcast(1.0), two = N::broadcast(2.0);
  const auto first = q.number < one;  // number 0
  const auto last = two < q.number;   // number 3
  const auto third = one < q.number;  // number 2, or 3, which `last` excludes
  const N sine = select(first, r.sin, select(last, -r.cos, select(third, -r.sin, r.cos)));
  const N cosine = select(first, r.cos, select(last, r.sin, select(third, -r.cos, -r.sin)));
  return {clamp(sine, 1), clamp(cosine, 1)};
}
template <Plain N>
HWY_INLINE N sin(N x) {
  return sin_cos(x).sin;
}
template <Plain N>
HWY_INLINE N cos(N x) {
  return sin_cos(x).cos;
}
template <Plain N>
HWY_INLINE N tan(N x) {
  const Quarter<N> q = quarter_turns(x);
  const SinCos<N> r = sin_cos_reduced(q);
  const N one = N::broadcast(1.0);
  const auto even = abs(abs(q.number - one) - one) < one;  // among 0..3, only 0 and 2 differ from 1 by 1
  return select(even, r.sin, -r.cos) / select(even, r.cos, r.sin);
}

// Returns asin(s) - s for |s| <= 1/2.
template <Plain N>
HWY_INLINE N asin_excess(N s) {
  const N z = s * s;
  return s * (z * polynomial(z, Precision<N>::kAsin));
}
// Uses asin x = pi/2 - 2 asin sqrt((1 - x)/2) from x = 1/2 on, which keeps the polynomial's argument below 1/2.
template <Plain N>
HWY_INLINE N asin(N x) {
  using P = Precision<N>;
  const N half = N::broadcast(0.5), c = clamp(x, 1), a = abs(c);
  const auto small = a < half;
  const N s = select(small, a, sqrt((N::broadcast(1.0) - a) * half));
  const N excess = asin_excess(s);
  const N half_pi = N::broadcast(P::kPi[0] / 2), rest = N::broadcast(P::kPi[1] / 2);
  const N angle = select(small, s + excess, (half_pi - (s + s)) - ((excess + excess) - rest));
  return select(c < N::broadcast(0.0), -angle, angle);
}
template <Plain N>
HWY_INLINE N acos(N x) {
  using P = Precision<N>;
  const N half = N::broadcast(0.5), zero = N::broadcast(0.0), c = clamp(x, 1), a = abs(c);
  const auto small = a < half;
  const N s = select(small, c, sqrt((N::broadcast(1.0) - a) * half));
  const N excess = asin_excess(s);
  const N twice = (s + s) + (excess + excess);
  const N pi = N::broadcast(P::kPi[0]), rest = N::broadcast(P::kPi[1]);
  const N near = (pi * half - s) - (excess - rest * half);
  const N behind = (pi - (s + s)) - ((excess + excess) - rest);
  return select(small, near, select(c < zero, behind, twice));
}

// Returns the angle of the point (x, y), 0 <= y <= x, in [0, pi/4]. Angles above pi/8 are computed as
// pi/4 + atan((y - x)/(y + x)).
template <Plain N>
HWY_INLINE N atan_ratio(N y, N x) {
  using P = Precision<N>;
  const N q = y / x, one = N::broadcast(1.0), zero = N::broadcast(0.0);
  const auto small = q < N::broadcast(0.41421356237309503);
  const N s = select(small, q, (q - one) / (q + one));
  const N z = s * s;
  const N excess = s * (z * polynomial(z, P::kAtan));
  return select(small, zero, N::broadcast(P::kPi[0] / 4)) +
         (s + (excess + select(small, zero, N::broadcast(P::kPi[1] / 4))));
}
// Returns an angle in [-pi, pi]; 0 where both are 0. A negative zero counts as zero.
template <Plain N>
HWY_INLINE N atan2(N y, N x) {
  using P = Precision<N>;
  const N zero = N::broadcast(0.0), one = N::broadcast(1.0), ax = abs(x), ay = abs(y);
  const auto steep = ax < ay;
  const N low = select(steep, ax, ay), high = select(steep, ay, ax);
  // Equal operands, which may both be infinite, make 45 degrees; two zeros make 0 degrees.
  const auto less = low < high;
  const N first = atan_ratio(select(less, low, select(zero < high, one, zero)), select(less, high, one));
  const N half_pi = N::broadcast(P::kPi[0] / 2), half_rest = N::broadcast(P::kPi[1] / 2);
  const N upper = select(steep, half_pi - (first - half_rest), first);
  const N around =
      select(steep, half_pi + (first + half_rest), N::broadcast(P::kPi[0]) - (first - N::broadcast(P::kPi[1])));
  const N angle = select(x < zero, around, upper);
  return nan_from(x, y, select(y < zero, -angle, angle));
}
template <Plain N>
HWY_INLINE N atan(N x) {
  return atan2(x, N::broadcast(1.0));
}

// Returns infinity above the logarithm of the largest number and 0 below the logarithm of the smallest.
template <Plain N>
HWY_INLINE N exp(N x) {
  using P = Precision<N>;
  const N c = clamp(x, P::kExpLimit), one = N::broadcast(1.0);
  const N n = round_nearest(c * N::broadcast(1.4426950408889634074));
  const N r = (c - n * N::broadcast(P::kLn2[0])) - n * N::broadcast(P::kLn2[1]);
  const N y = one + (r + r * r * polynomial(r, kExp<P>.c));
  // 2^n in two factors, because n exceeds the range of exponents at both ends.
  const N half = floor(n * N::broadcast(0.5));
  return y * power_of_two(half) * power_of_two(n - half);
}

// Returns log((1+s)/(1-s)) / s - 2 = 2 z/3 + 2 z^2/5 + ..., z = s^2 <= (3 - 2 sqrt 2)^2 = 0.0295 (Abramowitz &
// Stegun, 4.1.27), summed from the last term: 5 terms err by 3e-9, 11 by 1e-18.
template <Plain N>
HWY_INLINE N log_series(N z, int terms) {
  N sum = N::broadcast(0.0);
  for (int i = terms; i >= 1; --i) sum = (sum + N::broadcast(2.0 / (2 * i + 1))) * z;
  return sum;
}
// Returns -infinity at 0 and NaN below. With x = 2^e (1 + f) and s = f/(2 + f), log(1 + f) is
// f - (f^2/2 - s (f^2/2 + series)), whose first term is exact.
template <Plain N>
HWY_INLINE N log(N x) {
  using P = Precision<N>;
  const N zero = N::broadcast(0.0), one = N::broadcast(1.0);
  const Scaled<N> parts = split_power_of_two(x);
  const N f = parts.mantissa - one, e = parts.exponent;
  const N s = f / (N::broadcast(2.0) + f), half = f * f * N::broadcast(0.5);
  const N rest = s * (half + log_series(s * s, P::kLogTerms)) + e * N::broadcast(P::kLn2[1]);
  const N result = e * N::broadcast(P::kLn2[0]) - ((half - rest) - f);
  const N infinity = N::broadcast(P::kInfinity);
  const N edge = select(x < zero, infinity - infinity, select(zero < x, x, nan_from(x, x, -infinity)));
  return select(zero < x, select(x < infinity, result, edge), edge);
}

// Returns e^(y log x) for x > 0. For x < 0 and an integer y the result is |x|^y, negated if y is odd; for other y it
// is NaN. At x = 0 the result is 0 for y > 0, 1 for y = 0 and infinite for y < 0. Relative error: (2 + 2 |y log x|)
// ulp.
template <Plain N>
HWY_INLINE N pow(N x, N y) {
  using P = Precision<N>;
  const N zero = N::broadcast(0.0), one = N::broadcast(1.0), infinity = N::broadcast(P::kInfinity);
  const N magnitude = exp(y * log(abs(x)));
  const N half = y * N::broadcast(0.5);
  const N fraction = y - floor(y), parity = half - floor(half);  // parity: 0 or 1/2 for an integer y
  const auto large = N::broadcast(P::kWholeFrom) < abs(y);
  const N whole = select(large, magnitude, select(zero < parity, -magnitude, magnitude));
  const N negative = select(zero < fraction, infinity - infinity, whole);
  const N at_zero = select(zero < y, zero, select(y < zero, infinity, one));
  const N result = select(x < zero, negative, select(zero < x, magnitude, at_zero));
  return nan_from(x, y, select(y < zero, result, select(zero < y, result, one)));
}

}  // namespace fathom::vm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
