// Sine and cosine of an angle in degrees, the same on every machine, unlike those of libm.
// Tested by: tests/compiler/frontend/elaborate/elaborate_test.cpp
#pragma once

#include <numbers>

namespace fathom::compiler {

inline constexpr double kDegree = std::numbers::pi / 180;  // radians per degree

struct SineCosine {
  double sine, cosine;
};

// Exact at whole quarter turns.
SineCosine sine_cosine(double degrees);

}  // namespace fathom::compiler
