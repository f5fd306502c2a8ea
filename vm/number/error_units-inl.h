// Units and roundings of the bounds of Slope (slope-inl.h).
// Tested by: tests/vm/interpret/formula_test.cpp, tests/vm/number/error_units_test.cpp
#if defined(FATHOM_VM_ERROR_UNITS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef FATHOM_VM_ERROR_UNITS_INL
#undef FATHOM_VM_ERROR_UNITS_INL
#else
#define FATHOM_VM_ERROR_UNITS_INL
#endif

#include <cmath>
#include <limits>

#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace fathom::vm::HWY_NAMESPACE {

inline constexpr double kUnbounded = std::numeric_limits<double>::infinity();
inline constexpr double kUnit = 0x1p-24;  // unit of errors

// Increases a bound by more than the rounding of the nonnegative doubles that it is a sum or product of. A NaN
// becomes kUnbounded.
inline double bound(double value) { return value >= 0 ? value * (1 + 1e-14) : kUnbounded; }
// Returns the length of a vector whose components are at most `a` and `b`, or a bound on it below 2^-400. std::hypot
// would not be the same on every processor.
inline double length_of(double a, double b) {
  const double sum = a + b;
  return sum > 0 && sum < 0x1p-400 ? 0x1p-400 : std::sqrt(a * a + b * b);
}
// Returns the error, in kUnit, of a rounding to f32 whose result is at most `size`. Subnormals have an absolute
// error; overflow has no bound.
inline double rounding(double size) { return size < 3.4e38 ? size + 0x1p-120 : kUnbounded; }

}  // namespace fathom::vm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
