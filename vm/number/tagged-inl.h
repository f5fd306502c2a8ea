// Tagged<T>: a number and the surface it belongs to. min, max and select return the chosen operand's surface, sums
// and products the left operand's. So a run of the program yields the distance and the surface it belongs to.
#if defined(FATHOM_VM_TAGGED_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef FATHOM_VM_TAGGED_INL
#undef FATHOM_VM_TAGGED_INL
#else
#define FATHOM_VM_TAGGED_INL
#endif

#include "vm/number/number-inl.h"

HWY_BEFORE_NAMESPACE();
namespace fathom::vm::HWY_NAMESPACE {

template <class T>
struct Tagged {
  using Constant = typename T::Constant;
  T v;
  Constant surface;  // the surface's number as a float: exact below 2^24, which the 24-bit operand guarantees
};

template <class T>
HWY_INLINE Tagged<T> operator-(const Tagged<T>& a) {
  return {-a.v, a.surface};
}
template <class T>
HWY_INLINE Tagged<T> operator+(const Tagged<T>& a, const Tagged<T>& b) {
  return {a.v + b.v, a.surface};
}
template <class T>
HWY_INLINE Tagged<T> operator-(const Tagged<T>& a, const Tagged<T>& b) {
  return {a.v - b.v, a.surface};
}
template <class T>
HWY_INLINE Tagged<T> operator*(const Tagged<T>& a, const Tagged<T>& b) {
  return {a.v * b.v, a.surface};
}
template <class T>
HWY_INLINE Tagged<T> operator-(const Tagged<T>& a, Constant<T> b) {
  return {a.v - b, a.surface};
}
template <class T>
HWY_INLINE Tagged<T> operator-(Constant<T> a, const Tagged<T>& b) {
  return {a - b.v, b.surface};
}
template <class T>
HWY_INLINE Tagged<T> operator*(const Tagged<T>& a, Constant<T> b) {
  return {a.v * b, a.surface};
}
template <class T>
HWY_INLINE Tagged<T> abs(const Tagged<T>& a) {
  return {abs(a.v), a.surface};
}
template <class T>
HWY_INLINE Tagged<T> sqr(const Tagged<T>& a) {
  return {sqr(a.v), a.surface};
}
template <class T>
HWY_INLINE Tagged<T> max(Constant<T> a, const Tagged<T>& b) {
  return {max(a, b.v), b.surface};
}
// Returns the winner's surface. If a and b are equal, the lower surface number wins, independent of the operands'
// order.
template <class T, class Mask>
HWY_INLINE Constant<T> choose(Mask a_wins, Mask b_wins, const Tagged<T>& a, const Tagged<T>& b) {
  const Constant<T> at_tie = min(a.surface, b.surface);
  return select(a_wins, a.surface, select(b_wins, b.surface, at_tie));
}
template <class T>
HWY_INLINE Tagged<T> min(const Tagged<T>& a, const Tagged<T>& b) {
  return {min(a.v, b.v), choose(a.v < b.v, b.v < a.v, a, b)};
}
template <class T>
HWY_INLINE Tagged<T> max(const Tagged<T>& a, const Tagged<T>& b) {
  return {max(a.v, b.v), choose(b.v < a.v, a.v < b.v, a, b)};
}

template <class T>
HWY_INLINE auto operator<(const Tagged<T>& a, Constant<T> b) {
  return a.v < b;
}
template <class T, class Mask>
HWY_INLINE Tagged<T> select(Mask mask, const Tagged<T>& yes, const Tagged<T>& no) {
  return {select(mask, yes.v, no.v), select(mask, yes.surface, no.surface)};
}
template <class T>
HWY_INLINE Tagged<T> min(Constant<T> a, const Tagged<T>& b) {
  return {min(a, b.v), b.surface};
}
template <class T>
HWY_INLINE Tagged<T> length(const Tagged<T>& x, const Tagged<T>& y) {
  return {length(x.v, y.v), x.surface};
}

template <class T>
HWY_INLINE Tagged<T> operator+(const Tagged<T>& a, Constant<T> b) {
  return {a.v + b, a.surface};
}
template <class T>
HWY_INLINE Tagged<T> floor(const Tagged<T>& a) {
  return {floor(a.v), a.surface};
}

}  // namespace fathom::vm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
