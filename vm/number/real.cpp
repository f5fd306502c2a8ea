#include "vm/number/real.h"

#include <cmath>

#undef HWY_TARGET_INCLUDE
#include "vm/number/noise-inl.h"

namespace fathom::vm::real {
namespace {

namespace kernels = fathom::vm::HWY_NAMESPACE;
using kernels::Real;

// Returns sine and cosine of an angle. `quarter`: a quarter turn in the angle's unit. The difference from the nearest
// whole quarter is exact.
SinCos sin_cos(double angle, double quarter) {
  const double quarters = std::floor(angle / quarter + 0.5);
  const double x = (angle - quarter * quarters) * (std::numbers::pi / 2 / quarter);
  const auto [sine, cosine] = kernels::sin_cos_reduced(kernels::Quarter<Real>{{x}, {0}, {0}});
  switch (static_cast<int>(quarters) & 3) {
    case 0:
      return {sine.v, cosine.v};
    case 1:
      return {cosine.v, -sine.v};
    case 2:
      return {-sine.v, -cosine.v};
    default:
      return {-cosine.v, sine.v};
  }
}

}  // namespace

double sin(double x) { return kernels::sin(Real{x}).v; }
double cos(double x) { return kernels::cos(Real{x}).v; }
double tan(double x) { return kernels::tan(Real{x}).v; }
SinCos sin_cos_turns(double turns) { return sin_cos(turns, 0.25); }
SinCos sin_cos_degrees(double degrees) { return sin_cos(std::fmod(degrees, 360), 90); }
double asin(double x) { return kernels::asin(Real{x}).v; }
double acos(double x) { return kernels::acos(Real{x}).v; }
double atan(double x) { return kernels::atan(Real{x}).v; }
double atan2(double y, double x) { return kernels::atan2(Real{y}, Real{x}).v; }
double exp(double x) { return kernels::exp(Real{x}).v; }
double log(double x) { return kernels::log(Real{x}).v; }
double pow(double x, double y) { return kernels::pow(Real{x}, Real{y}).v; }
double noise(double x, double y, double z) { return kernels::noise(Real{x}, Real{y}, Real{z}).v; }

}  // namespace fathom::vm::real
