// What a number type must supply to run in the machine. The opcodes never ask which type they run on.
//
// A number type T has T::Constant, the type of immediates (a constant carries no derivative), and
//
//   + - * /  unary -          abs  sqrt  sqr  log
//   min(a, b) = a < b ? a : b             max(a, b) = a > b ? a : b        (one rule for ties and NaN: b)
//   length(x, y)  length(x, y, z)         gradient zero where the length is zero
//   a < b, a > b  -> a mask; any(mask); select(mask, yes, no)
//
// with either operand a constant. The types: Batch (f32 lanes, batch-inl.h), Real (double, real-inl.h), Interval
// (interval-inl.h), and over those Dual (derivatives, dual-inl.h) and Tagged (which surface won, tagged-inl.h).
//
// These headers are compiled once for each instruction set, hence "-inl" and the namespace HWY_NAMESPACE.
#if defined(FATHOM_VM_NUMBER_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef FATHOM_VM_NUMBER_INL
#undef FATHOM_VM_NUMBER_INL
#else
#define FATHOM_VM_NUMBER_INL
#endif

#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace fathom::vm::HWY_NAMESPACE {

template <class T>
struct Vec3 {
  T x, y, z;
};

template <class T>
using Constant = typename T::Constant;

template <class T>
HWY_INLINE Constant<T> constant(double value) {
  return Constant<T>::broadcast(value);
}

// Terms of log((1+s)/(1-s)) / (2s) - 1 = z/3 + z^2/5 + ..., z = s^2 <= (3 - 2 sqrt 2)^2 = 0.0295 (Abramowitz &
// Stegun, "Handbook of Mathematical Functions", 1964, 4.1.27), summed from the last: 5 terms err by 3e-9, 11 by
// 1e-18.
template <class N>
HWY_INLINE N log_series(N z, int terms) {
  N sum = N::broadcast(0.0);
  for (int i = terms; i >= 1; --i) sum = (sum + N::broadcast(1.0 / (2 * i + 1))) * z;
  return sum;
}

}  // namespace fathom::vm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
