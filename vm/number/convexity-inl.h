// Convex<T>: a distance and a convexity radius, within which the solid around the point is convex. Convex shapes have
// such a radius, and so have their unions, intersections, scalings and growing offsets, and their blends away from
// the blended region. For all other results the radius is |distance|.
//
// Let L be the distance's Lipschitz constant, p the point, and x any point within convex / L of p. Then either v(x)
// is at least convex - L |x - p|, or max(v(x), 0) equals a convex function, the same function for all such x. So a
// ray that leaves a convex solid does not return to it, and a ray that approaches it does not hit it before the zero
// of the line through two of its values.
#if defined(FATHOM_VM_CONVEXITY_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef FATHOM_VM_CONVEXITY_INL
#undef FATHOM_VM_CONVEXITY_INL
#else
#define FATHOM_VM_CONVEXITY_INL
#endif

#include "vm/number/number-inl.h"

HWY_BEFORE_NAMESPACE();
namespace fathom::vm::HWY_NAMESPACE {

template <class T>
struct Convex {
  using Constant = typename T::Constant;
  T v;
  Constant convex;  // convexity radius; at least |v|, because within |v| space is all empty or all solid
};

template <class T>
HWY_INLINE Constant<T> value_of(const Convex<T>& a) {
  return value_of(a.v);
}
// Returns a value of unknown convexity: the radius is |v|.
template <class T>
HWY_INLINE Convex<T> plain(const T& v) {
  return {v, abs(value_of(v))};
}

// Union. Within b's distance only a's solid is present, so a's radius holds up to there, and vice versa. Within the
// lesser distance there is no surface at all.
template <class T>
HWY_INLINE Convex<T> min(const Convex<T>& a, const Convex<T>& b) {
  const Constant<T> x = value_of(a), y = value_of(b);
  return {min(a.v, b.v), max(max(min(a.convex, y), min(b.convex, x)), abs(min(x, y)))};
}
// Convexity radius of an intersection: the lesser of the operands' radii. Within the greater distance the
// intersection is empty, so that distance is a radius too.
template <class T>
HWY_INLINE Constant<T> convex_intersection(const Convex<T>& a, const Convex<T>& b) {
  return max(min(a.convex, b.convex), max(value_of(a), value_of(b)));
}
template <class T>
HWY_INLINE Convex<T> max(const Convex<T>& a, const Convex<T>& b) {
  return {max(a.v, b.v), convex_intersection(a, b)};
}
// Blend v of width k, which equals `sharp` where a and b differ by more than k. Within the distance `apart`, a and b
// still differ by more than k even if they change in opposite directions.
template <class T>
HWY_INLINE Convex<T> blend(const T& v, const Convex<T>& a, const Convex<T>& b, Constant<T> k,
                           const Convex<T>& sharp) {
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
