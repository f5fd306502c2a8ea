// Angles in radians.
#pragma once

#include <numbers>

namespace fathom::runtime {

inline constexpr double kPi = std::numbers::pi;
inline constexpr double kDegree = kPi / 180;

}  // namespace fathom::runtime
