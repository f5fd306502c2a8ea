#include "compiler/geometry/sine_cosine.h"

#include <cmath>
#include <numbers>

namespace fathom::compiler {

// Evaluates the Taylor series at the angle's difference from the nearest quarter turn, at most pi/4. The terms fall
// below 2^-53 after x^18/18!.
SineCosine sine_cosine(double degrees) {
  const double turned = std::fmod(degrees, 360.0);
  const double quarters = std::floor(turned / 90.0 + 0.5);
  const double x = (turned - 90.0 * quarters) * (std::numbers::pi / 180);
  double term = 1, sine = 0, cosine = 0;
  for (int n = 0; n < 20; n += 2) {
    cosine += term;
    term *= x / (n + 1);
    sine += term;
    term *= -x / (n + 2);
  }
  switch ((static_cast<int>(quarters) + 4) % 4) {
    case 0:
      return {sine, cosine};
    case 1:
      return {cosine, -sine};
    case 2:
      return {-sine, -cosine};
    default:
      return {-cosine, sine};
  }
}

}  // namespace fathom::compiler
