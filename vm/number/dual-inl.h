// Dual<N>: a number and its three partial derivatives, by the chain rule (forward-mode differentiation; Griewank &
// Walther, "Evaluating Derivatives", 2008, chapter 3). At a tie of min or max the derivative is the chosen branch's;
// where a length is zero it is zero: never NaN on finite input.
#if defined(FATHOM_VM_DUAL_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef FATHOM_VM_DUAL_INL
#undef FATHOM_VM_DUAL_INL
#else
#define FATHOM_VM_DUAL_INL
#endif

#include "vm/number/number-inl.h"

HWY_BEFORE_NAMESPACE();
namespace fathom::vm::HWY_NAMESPACE {

template <class N>
struct Dual {
  using Constant = N;
  N v;           // value
  N dx, dy, dz;  // its derivatives along x, y and z
};

// A dual with value v and a's derivatives times s.
template <class N>
HWY_INLINE Dual<N> chain(N v, const Dual<N>& a, N s) {
  return {v, a.dx * s, a.dy * s, a.dz * s};
}
template <class N>
HWY_INLINE Dual<N> no_derivative(N v) {
  const N zero = N::broadcast(0.0);
  return {v, zero, zero, zero};
}

template <class N>
HWY_INLINE Dual<N> operator+(const Dual<N>& a, const Dual<N>& b) {
  return {a.v + b.v, a.dx + b.dx, a.dy + b.dy, a.dz + b.dz};
}
template <class N>
HWY_INLINE Dual<N> operator-(const Dual<N>& a, const Dual<N>& b) {
  return {a.v - b.v, a.dx - b.dx, a.dy - b.dy, a.dz - b.dz};
}
template <class N>
HWY_INLINE Dual<N> operator*(const Dual<N>& a, const Dual<N>& b) {
  return {a.v * b.v, a.v * b.dx + b.v * a.dx, a.v * b.dy + b.v * a.dy, a.v * b.dz + b.v * a.dz};
}
template <class N>
HWY_INLINE Dual<N> operator/(const Dual<N>& a, const Dual<N>& b) {
  const N q = a.v / b.v, inverse = N::broadcast(1.0) / b.v;
  return {q, (a.dx - q * b.dx) * inverse, (a.dy - q * b.dy) * inverse, (a.dz - q * b.dz) * inverse};
}
template <class N>
HWY_INLINE Dual<N> operator-(const Dual<N>& a) {
  return {-a.v, -a.dx, -a.dy, -a.dz};
}
template <class N>
HWY_INLINE Dual<N> operator+(const Dual<N>& a, N b) {
  return {a.v + b, a.dx, a.dy, a.dz};
}
template <class N>
HWY_INLINE Dual<N> operator-(const Dual<N>& a, N b) {
  return {a.v - b, a.dx, a.dy, a.dz};
}
template <class N>
HWY_INLINE Dual<N> operator-(N a, const Dual<N>& b) {
  return {a - b.v, -b.dx, -b.dy, -b.dz};
}
template <class N>
HWY_INLINE Dual<N> operator*(const Dual<N>& a, N b) {
  return chain(a.v * b, a, b);
}

template <class N>
HWY_INLINE auto operator<(const Dual<N>& a, const Dual<N>& b) {
  return a.v < b.v;
}
template <class N>
HWY_INLINE auto operator<(const Dual<N>& a, N b) {
  return a.v < b;
}
template <class N>
HWY_INLINE auto operator<(N a, const Dual<N>& b) {
  return a < b.v;
}
template <class N>
HWY_INLINE auto operator>(const Dual<N>& a, N b) {
  return a.v > b;
}
template <class Mask, class N>
HWY_INLINE Dual<N> select(Mask m, const Dual<N>& yes, const Dual<N>& no) {
  return {select(m, yes.v, no.v), select(m, yes.dx, no.dx), select(m, yes.dy, no.dy), select(m, yes.dz, no.dz)};
}
template <class N>
HWY_INLINE Dual<N> min(const Dual<N>& a, const Dual<N>& b) {
  return select(a.v < b.v, a, b);
}
template <class N>
HWY_INLINE Dual<N> max(const Dual<N>& a, const Dual<N>& b) {
  return select(a.v > b.v, a, b);
}
template <class N>
HWY_INLINE Dual<N> min(N a, const Dual<N>& b) {
  return select(a < b.v, no_derivative(a), b);
}
template <class N>
HWY_INLINE Dual<N> max(N a, const Dual<N>& b) {
  return select(a > b.v, no_derivative(a), b);
}
template <class N>
HWY_INLINE Dual<N> abs(const Dual<N>& a) {
  const N one = N::broadcast(1.0);
  return chain(abs(a.v), a, select(a.v < N::broadcast(0.0), -one, one));
}
template <class N>
HWY_INLINE Dual<N> sqr(const Dual<N>& a) {
  return chain(a.v * a.v, a, a.v + a.v);
}
// 1/x, or 0 where x is 0.
template <class N>
HWY_INLINE N inverse_or_zero(N x) {
  const N zero = N::broadcast(0.0);
  return select(x > zero, N::broadcast(1.0) / x, zero);
}
template <class N>
HWY_INLINE Dual<N> sqrt(const Dual<N>& a) {
  const N root = sqrt(a.v);
  return chain(root, a, N::broadcast(0.5) * inverse_or_zero(root));
}
template <class N>
HWY_INLINE Dual<N> log(const Dual<N>& a) {
  return chain(log(a.v), a, N::broadcast(1.0) / a.v);
}
template <class N>
HWY_INLINE Dual<N> length(const Dual<N>& x, const Dual<N>& y) {
  const N l = length(x.v, y.v), s = inverse_or_zero(l), ux = x.v * s, uy = y.v * s;
  return {l, ux * x.dx + uy * y.dx, ux * x.dy + uy * y.dy, ux * x.dz + uy * y.dz};
}
template <class N>
HWY_INLINE Dual<N> length(const Dual<N>& x, const Dual<N>& y, const Dual<N>& z) {
  const N l = length(x.v, y.v, z.v), s = inverse_or_zero(l), ux = x.v * s, uy = y.v * s, uz = z.v * s;
  return {l, ux * x.dx + uy * y.dx + uz * z.dx, ux * x.dy + uy * y.dy + uz * z.dy, ux * x.dz + uy * y.dz + uz * z.dz};
}

}  // namespace fathom::vm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
