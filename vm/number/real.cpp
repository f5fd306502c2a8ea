#include "vm/number/real.h"

#undef HWY_TARGET_INCLUDE
#include "vm/number/noise-inl.h"

namespace fathom::vm::real {
namespace {

namespace kernels = fathom::vm::HWY_NAMESPACE;
using kernels::Real;

}  // namespace

double sin(double x) { return kernels::sin(Real{x}).v; }
double cos(double x) { return kernels::cos(Real{x}).v; }
double tan(double x) { return kernels::tan(Real{x}).v; }
double asin(double x) { return kernels::asin(Real{x}).v; }
double acos(double x) { return kernels::acos(Real{x}).v; }
double atan(double x) { return kernels::atan(Real{x}).v; }
double atan2(double y, double x) { return kernels::atan2(Real{y}, Real{x}).v; }
double exp(double x) { return kernels::exp(Real{x}).v; }
double log(double x) { return kernels::log(Real{x}).v; }
double pow(double x, double y) { return kernels::pow(Real{x}, Real{y}).v; }
double noise(double x, double y, double z) { return kernels::noise(Real{x}, Real{y}, Real{z}).v; }

}  // namespace fathom::vm::real
