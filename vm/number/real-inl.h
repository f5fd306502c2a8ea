// Real: one double.
#if defined(FATHOM_VM_REAL_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef FATHOM_VM_REAL_INL
#undef FATHOM_VM_REAL_INL
#else
#define FATHOM_VM_REAL_INL
#endif

#include <bit>
#include <cmath>
#include <cstdint>

#include "vm/number/number-inl.h"

HWY_BEFORE_NAMESPACE();
namespace fathom::vm::HWY_NAMESPACE {

struct Real {
  using Constant = Real;
  double v;

  static HWY_INLINE Real broadcast(double value) { return {value}; }
};

HWY_INLINE Real operator+(Real a, Real b) { return {a.v + b.v}; }
HWY_INLINE Real operator-(Real a, Real b) { return {a.v - b.v}; }
HWY_INLINE Real operator*(Real a, Real b) { return {a.v * b.v}; }
HWY_INLINE Real operator/(Real a, Real b) { return {a.v / b.v}; }
HWY_INLINE Real operator-(Real a) { return {-a.v}; }
HWY_INLINE bool operator<(Real a, Real b) { return a.v < b.v; }
HWY_INLINE bool operator>(Real a, Real b) { return a.v > b.v; }
HWY_INLINE bool operator<=(Real a, Real b) { return a.v <= b.v; }
HWY_INLINE bool operator>=(Real a, Real b) { return a.v >= b.v; }
HWY_INLINE bool operator==(Real a, Real b) { return a.v == b.v; }
HWY_INLINE bool any(bool mask) { return mask; }
HWY_INLINE Real select(bool mask, Real yes, Real no) { return mask ? yes : no; }
HWY_INLINE Real min(Real a, Real b) { return a.v < b.v ? a : b; }
HWY_INLINE Real max(Real a, Real b) { return a.v > b.v ? a : b; }
HWY_INLINE Real abs(Real a) { return {std::fabs(a.v)}; }
HWY_INLINE Real sqr(Real a) { return a * a; }
HWY_INLINE Real sqrt(Real a) { return {std::sqrt(a.v)}; }
HWY_INLINE Real length(Real x, Real y) { return sqrt(x * x + y * y); }
HWY_INLINE Real length(Real x, Real y, Real z) { return sqrt(x * x + y * y + z * z); }

HWY_INLINE bool is_nan(Real a) { return a.v != a.v; }

// Rounds half to even: adding 2^52 leaves no bits for a fraction, so the default rounding mode decides. Like in
// Batch, no result is -0.
HWY_INLINE Real round_nearest(Real a) {
  const double m = std::fabs(a.v);
  return {(m < 0x1p52 ? std::copysign((m + 0x1p52) - 0x1p52, a.v) : a.v) + 0.0};
}
HWY_INLINE Real floor(Real a) {
  const Real nearest = round_nearest(a);
  return {nearest.v > a.v ? nearest.v - 1 : nearest.v};
}
HWY_INLINE Real ceil(Real a) { return {0.0 - floor(-a).v}; }

// Returns 2^n for an integer n in [-1022, 1023].
HWY_INLINE Real power_of_two(Real n) {
  const double whole = n.v == n.v ? n.v : 0;
  return {std::bit_cast<double>((static_cast<std::int64_t>(whole) + 1023) << 52)};
}
HWY_INLINE Scaled<Real> split_power_of_two(Real x) {
  const bool subnormal = x.v < 0x1p-1022;
  // Unsigned, because the difference can wrap around for a negative x, whose result is never used.
  const auto bits = std::bit_cast<std::uint64_t>(subnormal ? x.v * 0x1p54 : x.v);
  const std::int64_t exponent = static_cast<std::int64_t>(bits - 0x3fe6a09e667f3bcd) >> 52;
  return {{std::bit_cast<double>(bits - (static_cast<std::uint64_t>(exponent) << 52))},
          {static_cast<double>(subnormal ? exponent - 54 : exponent)}};
}

}  // namespace fathom::vm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
