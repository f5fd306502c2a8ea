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
HWY_INLINE bool any(bool mask) { return mask; }
HWY_INLINE Real select(bool mask, Real yes, Real no) { return mask ? yes : no; }
HWY_INLINE Real min(Real a, Real b) { return a.v < b.v ? a : b; }
HWY_INLINE Real max(Real a, Real b) { return a.v > b.v ? a : b; }
HWY_INLINE Real abs(Real a) { return {std::fabs(a.v)}; }
HWY_INLINE Real sqr(Real a) { return a * a; }
HWY_INLINE Real sqrt(Real a) { return {std::sqrt(a.v)}; }
HWY_INLINE Real length(Real x, Real y) { return sqrt(x * x + y * y); }
HWY_INLINE Real length(Real x, Real y, Real z) { return sqrt(x * x + y * y + z * z); }

// x normal and positive; as for Batch, with the longer series. libm's log differs between machines.
HWY_INLINE Real log(Real x) {
  const auto bits = std::bit_cast<std::int64_t>(x.v);
  const std::int64_t exponent = (bits - 0x3fe6a09e667f3bcd) >> 52;
  const Real m{std::bit_cast<double>(bits - exponent * (std::int64_t{1} << 52))};
  const Real s = (m - Real{1.0}) / (m + Real{1.0});
  const Real twice = s + s;
  return Real{static_cast<double>(exponent) * 0.6931471805599453} + (twice + twice * log_series(s * s, 11));
}

}  // namespace fathom::vm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
