// What is proved of the machine's gradient noise (vm/number/noise-inl.h), whatever its hash may be.
//
// The noise is linear in each corner's direction, and so are its derivatives. So the worst choice of directions is
// the worst of each corner by itself: the largest |v . g| over the twelve directions g is the sum of the two largest
// coordinates of |v|. That leaves a maximum over one cell for the value, and over one cell and the unit sphere for
// the gradient's length; tests/vm/number/noise_test.cpp proves both by interval subdivision. Met are 1.03635 and, in a
// cell's centre along an axis, 3.75.
#pragma once

#include <array>
#include <cstddef>

namespace fathom::vm {

inline constexpr double kNoiseRange = 1.0364;
// [i]: where some coordinate is within (i + 1) / 16 of a whole number. A terrain takes the noise of a plane, and a
// plane near the lattice's has gentler slopes.
inline constexpr std::array<double, 8> kNoiseSlopes = {2.9, 3, 3.2, 3.3, 3.45, 3.65, 3.8, 3.85};
inline constexpr double kNoiseSlope = kNoiseSlopes.back();
// `off`: how far some coordinate is from a whole number, at most; in [0, 1/2].
constexpr double noise_slope(double off) {
  const double part = off * 16;
  std::size_t i = 0;
  while (i + 1 < kNoiseSlopes.size() && part > static_cast<double>(i + 1)) ++i;
  return kNoiseSlopes[i];
}
// Coordinates count as no further from 0 than this: f32 knows halves there, and its hash is still exact.
inline constexpr double kNoiseReach = 0x1p22;
// How far f32 is from the exact noise of the same point, in units of 2^-24; the test says what is met.
inline constexpr double kNoiseUnits = 16;

}  // namespace fathom::vm
