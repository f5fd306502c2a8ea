// Dual<N>: a number and its three partial derivatives, by the chain rule (forward-mode differentiation; Griewank &
// Walther, "Evaluating Derivatives", 2008, chapter 3). At a tie of min or max the derivative is that of the chosen
// branch. The derivative of a zero length is zero, so derivatives are never NaN on finite input.
#if defined(FATHOM_VM_DUAL_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef FATHOM_VM_DUAL_INL
#undef FATHOM_VM_DUAL_INL
#else
#define FATHOM_VM_DUAL_INL
#endif

#include "vm/number/elementary-inl.h"

HWY_BEFORE_NAMESPACE();
namespace fathom::vm::HWY_NAMESPACE {

template <class N>
struct Dual {
  using Constant = N;
  N v;           // value
  N dx, dy, dz;  // derivatives along x, y and z
};

template <class N>
HWY_INLINE N value_of(const Dual<N>& a) {
  return a.v;
}

// Returns a dual with value v and a's derivatives times s.
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
HWY_INLINE Dual<N> operator/(N a, const Dual<N>& b) {
  const N q = a / b.v;
  return chain(q, b, -q / b.v);
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
// Returns 1/x for x > 0, else 0.
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
HWY_INLINE Dual<N> length(const Dual<N>& x, const Dual<N>& y) {
  const N l = length(x.v, y.v), s = inverse_or_zero(l), ux = x.v * s, uy = y.v * s;
  return {l, ux * x.dx + uy * y.dx, ux * x.dy + uy * y.dy, ux * x.dz + uy * y.dz};
}
template <class N>
HWY_INLINE Dual<N> length(const Dual<N>& x, const Dual<N>& y, const Dual<N>& z) {
  const N l = length(x.v, y.v, z.v), s = inverse_or_zero(l), ux = x.v * s, uy = y.v * s, uz = z.v * s;
  return {l, ux * x.dx + uy * y.dx + uz * z.dx, ux * x.dy + uy * y.dy + uz * z.dy, ux * x.dz + uy * y.dz + uz * z.dz};
}

// Returns 1/x for x of either sign, or 0 where x is 0.
template <class N>
HWY_INLINE N signed_inverse_or_zero(N x) {
  const N zero = N::broadcast(0.0), inverse = N::broadcast(1.0) / x;
  return select(x < zero, inverse, select(zero < x, inverse, zero));
}
template <class N>
HWY_INLINE Dual<N> divide(const Dual<N>& a, const Dual<N>& b) {
  const N inverse = signed_inverse_or_zero(b.v), q = a.v * inverse;
  return {a.v / b.v, (a.dx - q * b.dx) * inverse, (a.dy - q * b.dy) * inverse, (a.dz - q * b.dz) * inverse};
}
template <class N>
HWY_INLINE Dual<N> sin(const Dual<N>& a) {
  const SinCos<N> r = sin_cos(a.v);
  return chain(r.sin, a, r.cos);
}
template <class N>
HWY_INLINE Dual<N> cos(const Dual<N>& a) {
  const SinCos<N> r = sin_cos(a.v);
  return chain(r.cos, a, -r.sin);
}
template <class N>
HWY_INLINE Dual<N> tan(const Dual<N>& a) {
  const N t = tan(a.v);
  return chain(t, a, N::broadcast(1.0) + t * t);
}
// Returns the derivative 1/sqrt(1 - x^2), or 0 where asin and acos clamp x.
template <class N>
HWY_INLINE N asin_slope(N x) {
  const N one = N::broadcast(1.0);
  return inverse_or_zero(sqrt((one - x) * (one + x)));
}
template <class N>
HWY_INLINE Dual<N> asin(const Dual<N>& a) {
  return chain(asin(a.v), a, asin_slope(a.v));
}
template <class N>
HWY_INLINE Dual<N> acos(const Dual<N>& a) {
  return chain(acos(a.v), a, -asin_slope(a.v));
}
template <class N>
HWY_INLINE Dual<N> atan(const Dual<N>& a) {
  const N one = N::broadcast(1.0);
  return chain(atan(a.v), a, one / (one + a.v * a.v));
}
template <class N>
HWY_INLINE Dual<N> exp(const Dual<N>& a) {
  const N e = exp(a.v);
  return chain(e, a, e);
}
template <class N>
HWY_INLINE Dual<N> log(const Dual<N>& a) {
  return chain(log(a.v), a, inverse_or_zero(a.v));
}
template <class N>
HWY_INLINE Dual<N> atan2(const Dual<N>& y, const Dual<N>& x) {
  const N s = inverse_or_zero(x.v * x.v + y.v * y.v), u = x.v * s, w = y.v * s;
  return {atan2(y.v, x.v), u * y.dx - w * x.dx, u * y.dy - w * x.dy, u * y.dz - w * x.dz};
}
// Returns `a`, or 0 for an infinite or NaN derivative, which gives no direction.
template <class N>
HWY_INLINE N zero_unless_finite(N a) {
  return select(abs(a) < N::broadcast(Precision<N>::kInfinity), a, N::broadcast(0.0));
}
// d(x^y) = y x^(y-1) dx + x^y log x dy, where the second term is 0 unless x > 0.
template <class N>
HWY_INLINE Dual<N> pow(const Dual<N>& x, const Dual<N>& y) {
  const N p = pow(x.v, y.v), zero = N::broadcast(0.0), one = N::broadcast(1.0);
  const N at_zero = select(y.v < one, zero, select(one < y.v, zero, one));
  const N by_x = select(abs(x.v) > zero, y.v * (p / x.v), at_zero);
  const N s = zero_unless_finite(by_x), t = zero_unless_finite(select(zero < x.v, p * log(x.v), zero));
  return {p, s * x.dx + t * y.dx, s * x.dy + t * y.dy, s * x.dz + t * y.dz};
}
template <class N>
HWY_INLINE Dual<N> mod(const Dual<N>& a, const Dual<N>& b) {
  const N turns = zero_unless_finite(floor(a.v / b.v));
  return {mod(a.v, b.v), a.dx - turns * b.dx, a.dy - turns * b.dy, a.dz - turns * b.dz};
}
template <class N>
HWY_INLINE Dual<N> floor(const Dual<N>& a) {
  return no_derivative(floor(a.v));
}
template <class N>
HWY_INLINE Dual<N> ceil(const Dual<N>& a) {
  return no_derivative(ceil(a.v));
}
template <class N>
HWY_INLINE Dual<N> round_nearest(const Dual<N>& a) {
  return no_derivative(round_nearest(a.v));
}
template <class N>
HWY_INLINE Dual<N> sign(const Dual<N>& a) {
  return no_derivative(sign(a.v));
}
template <class N>
HWY_INLINE Dual<N> logical_not(const Dual<N>& a) {
  return no_derivative(logical_not(a.v));
}
template <class N>
HWY_INLINE Dual<N> compare(const Dual<N>& a, const Dual<N>& b) {
  return no_derivative(compare(a.v, b.v));
}
template <class N>
HWY_INLINE Dual<N> step(const Dual<N>& edge, const Dual<N>& x) {
  return no_derivative(step(edge.v, x.v));
}
template <class N>
HWY_INLINE Dual<N> logical_and(const Dual<N>& a, const Dual<N>& b) {
  return select(abs(a.v) > N::broadcast(0.0), b, a);
}
template <class N>
HWY_INLINE Dual<N> logical_or(const Dual<N>& a, const Dual<N>& b) {
  const N value = logical_or(a.v, b.v);
  Dual<N> chosen = select(abs(a.v) > N::broadcast(0.0), a, b);
  chosen.v = value;
  return chosen;
}

}  // namespace fathom::vm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
