// Proved bounds of gradient noise (vm/number/noise-inl.h), for any hash.
//
// The noise and its derivatives are linear in each corner's direction. So the worst case is the worst direction of
// each corner by itself: the largest |v . g| over the twelve directions g is the sum of the two largest coordinates
// of |v|. The bounds are then a maximum over one cell for the value, and over one cell and the unit sphere for the
// gradient's length. tests/vm/number/noise_test.cpp proves both by interval subdivision. The largest values found are
// 1.03635 and, in a cell's centre along an axis, 3.75.
#pragma once

#include <array>
#include <cstddef>

namespace fathom::vm {

inline constexpr double kNoiseRange = 1.0364;
// Maximum gradient lengths: [i] holds where some coordinate is within (i + 1) / 16 of an integer. Terrains evaluate
// the noise on a plane, and planes near a lattice plane have gentler slopes.
inline constexpr std::array<double, 8> kNoiseSlopes = {2.9, 3, 3.2, 3.3, 3.45, 3.65, 3.8, 3.85};
inline constexpr double kNoiseSlope = kNoiseSlopes.back();
// Returns the maximum gradient length where some coordinate is at most `off` from an integer; `off` is in [0, 1/2].
constexpr double noise_slope(double off) {
  const double part = off * 16;
  std::size_t i = 0;
  while (i + 1 < kNoiseSlopes.size() && part > static_cast<double>(i + 1)) ++i;
  return kNoiseSlopes[i];
}
// Coordinates are clamped to this distance from 0, where f32 still resolves halves and the hash is still exact.
inline constexpr double kNoiseReach = 0x1p22;
// Maximum error of f32 noise at an f32 point, in units of 2^-24; the test states the largest error found.
inline constexpr double kNoiseUnits = 16;

}  // namespace fathom::vm
