// The interface of number types, over which the interpreter and the opcodes are templates.
//
// A number type T has T::Constant, the type of immediates (a constant carries no derivative), and
//
//   + - * /  unary -          abs  sqrt  sqr
//   sin cos tan asin acos atan exp log    no libm; asin and acos clamp their argument, log(0) = -infinity
//   floor ceil round_nearest sign         round_nearest: half to even; sign: -1, 0, 1
//   atan2(y, x)  pow(x, y)  mod(a, b)     atan2(0, 0) = 0; mod(a, b) = a - b floor(a / b)
//   noise(x, y, z)                        gradient noise, noise-inl.h
//   divide(a, b)                          a / b, whose derivative is 0 where b is 0
//   logical_not(a)  logical_and(a, b)  logical_or(a, b)  compare(a, b)  step(edge, x)    as in vm/program/opcodes.def
//   min(a, b) = a < b ? a : b             max(a, b) = a > b ? a : b        (one rule for ties and NaN: b)
//   length(x, y)  length(x, y, z)         gradient zero where the length is zero
//   a < b, a > b  -> a mask; any(mask); select(mask, yes, no)
//
// where either operand of + - * min max < > can be a constant. Convex and Tagged supply only the functions that
// vm/interpret/operators-inl.h applies to values. The types:
//
//   Batch, RealBatch   f32 and double lanes, batch-inl.h
//   Real               double, real-inl.h: the same bits as a lane of RealBatch
//   Interval           range of the exact value over a box, interval-inl.h
//   Along              ranges of value and derivative along a line, along-inl.h
//   Slope              ranges of value and gradient, and float error, over a box, slope-inl.h
//   FloatInterval          range of the f32 results over a box per lane, float_interval-inl.h
//   Dual<N>            value and partial derivatives over Batch or Real, dual-inl.h
//   Convex<T>          value and convexity radius, convexity-inl.h
//   Tagged<T>          value and the surface it belongs to, tagged-inl.h
//   Recorded           no value: records the operations applied to it, recorded-inl.h
//
// These headers are compiled once per instruction set, hence "-inl" and the namespace HWY_NAMESPACE.
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

// Returns a number without its derivatives, for terms that do not change the result in first order.
template <class T>
HWY_INLINE Constant<T> value_of(const T& a) {
  return a;
}

// x = 2^exponent * mantissa with mantissa in [sqrt 1/2, sqrt 2), for x finite and positive.
template <class N>
struct Scaled {
  N mantissa, exponent;
};

}  // namespace fathom::vm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
