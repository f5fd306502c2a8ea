// Elementary functions of one float, for work at every bounce of a path. vm/number/real.h has those of one double.
//
// Plain additions and multiplications give the same bits on every machine. glibc's sinf, expf and powf do not,
// because they take other paths on CPUs with fused multiply-add.
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

}  // namespace fathom::runtime
