// Angles in radians.
#pragma once

#include <numbers>

namespace fathom::runtime {

inline constexpr double kPi = std::numbers::pi;

}  // namespace fathom::runtime
