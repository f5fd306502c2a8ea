// Convex<T>: a number and how far around the point the solid it stands for is convex: of convex shapes, their unions and
// intersections, scaled, grown or blended elsewhere; of all other results no more is known than their distance.
//
// With L the number's Lipschitz constant: at a place x within convex / L of the point p, either v(x) is at least
// convex - L |x - p|, or max(v, 0) is there what some convex function is, the same for all such x. So a ray that leaves
// a convex solid does not come back to it, and one that comes nearer does not meet it before where the line through
// two of its values becomes 0.
#if defined(FATHOM_VM_CONVEX_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef FATHOM_VM_CONVEX_INL
#undef FATHOM_VM_CONVEX_INL
#else
#define FATHOM_VM_CONVEX_INL
#endif

#include "vm/number/number-inl.h"

HWY_BEFORE_NAMESPACE();
namespace fathom::vm::HWY_NAMESPACE {

template <class T>
struct Convex {
  using Constant = typename T::Constant;
  T v;
  Constant convex;  // at least |v|: so near the solid is empty or everything
};

template <class T>
HWY_INLINE Constant<T> value_of(const Convex<T>& a) {
  return value_of(a.v);
}
// What nothing more is known of than its value.
template <class T>
HWY_INLINE Convex<T> plain(const T& v) {
  return {v, abs(value_of(v))};
}

// Within the distance of the other, what one has; within that of either, nothing else is there.
template <class T>
HWY_INLINE Convex<T> min(const Convex<T>& a, const Convex<T>& b) {
  const Constant<T> x = value_of(a), y = value_of(b);
  return {min(a.v, b.v), max(max(min(a.convex, y), min(b.convex, x)), abs(min(x, y)))};
}
// What both have; within the distance of either, nothing is there.
template <class T>
HWY_INLINE Constant<T> convex_intersection(const Convex<T>& a, const Convex<T>& b) {
  return max(min(a.convex, b.convex), max(value_of(a), value_of(b)));
}
template <class T>
HWY_INLINE Convex<T> max(const Convex<T>& a, const Convex<T>& b) {
  return {max(a.v, b.v), convex_intersection(a, b)};
}
// A blend of width k; `sharp` is what it is where its operands differ by more, and still do when both have changed on
// the way.
template <class T>
HWY_INLINE Convex<T> blend(const T& v, const Convex<T>& a, const Convex<T>& b, Constant<T> k, const Convex<T>& sharp) {
  const Constant<T> apart = (abs(value_of(a) - value_of(b)) - k) * constant<T>(0.5);
  return {v, max(abs(value_of(v)), min(sharp.convex, apart))};
}

template <class T>
HWY_INLINE Convex<T> operator-(const Convex<T>& a) {
  return plain(-a.v);
}
template <class T>
HWY_INLINE Convex<T> operator+(const Convex<T>& a, const Convex<T>& b) {
  return plain(a.v + b.v);
}
template <class T>
HWY_INLINE Convex<T> operator-(const Convex<T>& a, const Convex<T>& b) {
  return plain(a.v - b.v);
}
template <class T>
HWY_INLINE Convex<T> operator*(const Convex<T>& a, const Convex<T>& b) {
  return plain(a.v * b.v);
}
template <class T>
HWY_INLINE Convex<T> operator+(const Convex<T>& a, Constant<T> b) {
  return plain(a.v + b);
}
template <class T>
HWY_INLINE Convex<T> operator-(const Convex<T>& a, Constant<T> b) {
  return plain(a.v - b);
}
template <class T>
HWY_INLINE Convex<T> operator-(Constant<T> a, const Convex<T>& b) {
  return plain(a - b.v);
}
template <class T>
HWY_INLINE Convex<T> operator*(const Convex<T>& a, Constant<T> b) {
  return plain(a.v * b);
}
template <class T>
HWY_INLINE Convex<T> abs(const Convex<T>& a) {
  return plain(abs(a.v));
}
template <class T>
HWY_INLINE Convex<T> sqr(const Convex<T>& a) {
  return plain(sqr(a.v));
}
template <class T>
HWY_INLINE Convex<T> floor(const Convex<T>& a) {
  return plain(floor(a.v));
}
template <class T>
HWY_INLINE Convex<T> length(const Convex<T>& x, const Convex<T>& y) {
  return plain(length(x.v, y.v));
}
template <class T>
HWY_INLINE Convex<T> min(Constant<T> a, const Convex<T>& b) {
  return plain(min(a, b.v));
}
template <class T>
HWY_INLINE Convex<T> max(Constant<T> a, const Convex<T>& b) {
  return plain(max(a, b.v));
}
template <class T>
HWY_INLINE auto operator<(const Convex<T>& a, const Convex<T>& b) {
  return a.v < b.v;
}
template <class T>
HWY_INLINE auto operator<(const Convex<T>& a, Constant<T> b) {
  return a.v < b;
}
template <class T, class Mask>
HWY_INLINE Convex<T> select(Mask mask, const Convex<T>& yes, const Convex<T>& no) {
  return plain(select(mask, yes.v, no.v));
}

}  // namespace fathom::vm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
