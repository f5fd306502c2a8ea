// Elementary functions in plain additions and multiplications. They give the same bits on every machine. glibc's
// sinf, expf and powf do not, because they take other paths on CPUs with fused multiply-add.
//
// Tested by: tests/runtime/base/elementary_test.cpp (error bounds against libm in double)
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <glm/vec3.hpp>

namespace fathom::runtime {

struct SinCos {
  float sin, cos;
};

// Sine and cosine of 2 pi u for u in [0,1]; absolute error <= 2e-7.
// Reduced to a quarter turn, then Moshier's minimax polynomials on [-pi/4, pi/4] (Cephes library, sinf.c, 1992).
inline SinCos sincos_turn(float u) {
  const float quarters = 4 * u;
  const int quadrant = static_cast<int>(quarters + 0.5f);
  const float x = (quarters - static_cast<float>(quadrant)) * 1.57079632679489662f;
  const float z = x * x;
  const float s = ((-1.9515295891e-4f * z + 8.3321608736e-3f) * z - 1.6666654611e-1f) * z * x + x;
  const float c =
      ((2.443315711809948e-5f * z - 1.388731625493765e-3f) * z + 4.166664568298827e-2f) * z * z - 0.5f * z + 1;
  // Avoids a branch on the quadrant, which no CPU can predict.
  const float pair[2] = {s, c};
  const auto q = static_cast<std::uint32_t>(quadrant);
  const auto signed_by = [](float magnitude, std::uint32_t bit) {
    return std::bit_cast<float>(std::bit_cast<std::uint32_t>(magnitude) ^ bit << 30);
  };
  return {signed_by(pair[q & 1], q & 2), signed_by(pair[~q & 1], (q + 1) & 2)};
}

struct SinCosReal {
  double sin, cos;
};

// Sine and cosine of 2 pi u for |u| <= 2^20; absolute error <= 1e-15 in addition to that of u.
// Reduced to a quarter turn, then Taylor's series on [-pi/4, pi/4], whose terms after x^17/17! are below 2^-60.
inline SinCosReal sincos_turn(double u) {
  const double quarters = 4 * u, nearest = std::floor(quarters + 0.5);
  const double x = (quarters - nearest) * 1.57079632679489661923;
  const double z = x * x;
  double s = 1, c = 1;
  for (int n = 16; n >= 2; n -= 2) {
    s = 1 - z * s * (1.0 / (n * (n + 1)));
    c = 1 - z * c * (1.0 / ((n - 1) * n));
  }
  s *= x;
  switch (static_cast<int>(nearest) & 3) {
    case 0:
      return {s, c};
    case 1:
      return {c, -s};
    case 2:
      return {-s, -c};
    default:
      return {-c, s};
  }
}

// e^x; relative error <= 2e-7. 0 below -87, infinity above 88.
// x = n ln 2 + r with ln 2 in two parts (Cody and Waite, "Software Manual for the Elementary Functions", 1980), then
// Moshier's polynomial for e^r (Cephes library, expf.c, 1992).
inline float exp(float x) {
  if (!(x >= -87)) return x != x ? x : 0.0f;
  if (x > 88) return INFINITY;
  const float n = static_cast<float>(static_cast<int>(x * 1.44269504088896341f + (x < 0 ? -0.5f : 0.5f)));
  const float r = (x - n * 0.693359375f) + n * 2.12194440e-4f;
  float y = 1.9875691500e-4f;
  y = y * r + 1.3981999507e-3f;
  y = y * r + 8.3334519073e-3f;
  y = y * r + 4.1665795894e-2f;
  y = y * r + 1.6666665459e-1f;
  y = y * r + 5.0000001201e-1f;
  y = y * r * r + r + 1;
  // 2^n in two factors, so that n = 127 + 1 and the subnormal end need no special case.
  const int half = static_cast<int>(n) / 2, rest = static_cast<int>(n) - half;
  return y * std::bit_cast<float>((half + 127) << 23) * std::bit_cast<float>((rest + 127) << 23);
}

inline glm::vec3 exp(glm::vec3 v) { return {exp(v.x), exp(v.y), exp(v.z)}; }

// 2^x, exact for whole x; relative error <= 2e-7 for |x| <= 100.
inline float exp2(float x) {
  const float n = static_cast<float>(static_cast<int>(x + (x < 0 ? -0.5f : 0.5f)));
  return exp((x - n) * 0.693147180559945309f) * std::bit_cast<float>((static_cast<int>(n) + 127) << 23);
}

// ln x; relative error <= 3e-7. Minus infinity at 0, NaN below.
// x = 2^n m with m in [sqrt(1/2), sqrt(2)), and ln m = 2 artanh(s) with s = (m - 1) / (m + 1), |s| <= 0.172, by its
// series, whose terms fall below 2^-24 of the sum after s^9.
inline float log(float x) {
  if (!(x > 0)) return x == 0 ? -INFINITY : NAN;
  if (x == INFINITY) return x;
  int n = 0;
  if (x < 0x1p-126f) {
    x *= 0x1p24f;
    n = -24;
  }
  // Subtracting the bits of sqrt(1/2) makes the exponent step there.
  const std::uint32_t bits = std::bit_cast<std::uint32_t>(x) - 0x3f3504f3u;
  n += static_cast<std::int32_t>(bits) >> 23;
  const float m = std::bit_cast<float>((bits & 0x007fffffu) + 0x3f3504f3u);
  const float s = (m - 1) / (m + 1), z = s * s;
  const float series = ((((2.0f / 9) * z + 2.0f / 7) * z + 2.0f / 5) * z + 2.0f / 3) * z * s + 2 * s;
  const float steps = static_cast<float>(n);
  return steps * 0.693359375f + (steps * -2.12194440e-4f + series);
}

inline glm::vec3 log(glm::vec3 v) { return {log(v.x), log(v.y), log(v.z)}; }

// tan x for x in [0, pi/2), relative error <= 1e-14: Taylor series of sine and cosine, whose terms fall below 2^-53
// of the sum after x^26/26! on this interval.
inline double tangent(double x) {
  double term = 1, sine = 0, cosine = 0;
  for (int n = 0; n < 28; n += 2) {
    cosine += term;
    term *= x / (n + 1);
    sine += term;
    term *= -x / (n + 2);
  }
  return sine / cosine;
}

// x^(1/2.4) for x in (0,1]; relative error <= 1e-13. x^(5/12) is the cube root of the fourth root of x^5. Newton's
// iteration y <- (2y + a/y^2)/3 gives the cube root, from y = 1, which lies above the root.
inline double power_5_12(double x) {
  const double a = std::sqrt(std::sqrt(x * x * x * x * x));
  double y = 1;
  for (int i = 0; i < 40; ++i) {
    const double next = (2 * y + a / (y * y)) / 3;
    if (next == y) break;
    y = next;
  }
  return y;
}

// log2 x for finite x > 0, subnormal ones too; error <= 4e-16 (1 + |log2 x|). x = 2^e m with m in [sqrt 1/2, sqrt 2],
// then ln m = 2 artanh s, s = (m - 1)/(m + 1), by its Taylor series, whose terms fall below 2^-53 of the sum after
// s^21.
inline double log2(double x) {
  const bool subnormal = x < 0x1p-1022;
  const auto bits = std::bit_cast<std::uint64_t>(subnormal ? x * 0x1p54 : x);
  int exponent = static_cast<int>(bits >> 52) - 1023 - (subnormal ? 54 : 0);
  double m = std::bit_cast<double>((bits & 0xfffffffffffffu) | 0x3ff0000000000000u);
  if (m > 1.4142135623730951) {
    m /= 2;
    ++exponent;
  }
  const double s = (m - 1) / (m + 1), z = s * s;
  double sum = 0;
  for (int n = 21; n > 0; n -= 2) sum = sum * z + 1.0 / n;
  return exponent + s * sum * 2.8853900817779268;  // 2 / ln 2
}

// 2^x in double for |x| <= 1000, exact for whole x; relative error <= 1e-15. The whole part of x is the exponent. The
// rest goes into the exponential's Taylor series, whose terms fall below 2^-53 after the 13th.
inline double exp2(double x) {
  const auto n = static_cast<std::int64_t>(x + (x < 0 ? -0.5 : 0.5));
  const double r = (x - static_cast<double>(n)) * 0.6931471805599453;
  double sum = 1;
  for (int i = 13; i > 0; --i) sum = sum * r / i + 1;
  return sum * std::bit_cast<double>(static_cast<std::uint64_t>(n + 1023) << 52);
}

// x^y for x >= 0, finite, and |y log2 x| <= 1000; relative error <= 1e-15 (1 + |y log2 x|). 0 for x = 0.
inline double power(double x, double y) { return x > 0 ? exp2(y * log2(x)) : 0; }

// Converts linear light to the sRGB signal, both clamped to [0,1]. NaN becomes 0. Source: IEC 61966-2-1:1999.
inline double srgb_encode(double linear) {
  if (!(linear > 0)) return 0;
  if (linear >= 1) return 1;
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * power_5_12(linear) - 0.055;
}

// Converts an sRGB signal in [0,1] to linear light.
inline double srgb_decode(double signal) {
  return signal <= 0.04045 ? signal / 12.92 : power((signal + 0.055) / 1.055, 2.4);
}

}  // namespace fathom::runtime
