// Gradient noise. A hash of each lattice point chooses one of the twelve directions from a cube's centre to the
// middles of its edges. Inside a cell, a quintic interpolates the eight linear functions that the corners' directions
// define, so that value, slope and curvature are continuous. Source: Perlin, "Improving Noise", 2002.
//
// The hash is (34 n + 10) n mod 289, a permutation, nested over the axes (Gustavson & McEwan, "Tiling simplex noise
// and flow noise in two and three dimensions", JCGT 2022). All its intermediate results are integers that f32
// represents exactly, so the hash is the same in f32 and in double and on every machine. The hash needs no integer
// types and no table, which lanes would have to gather from. The noise has period 289. Coordinates are clamped to
// kNoiseReach; a NaN gives NaN.
//
// These functions serve Batch, RealBatch, Real, their Duals and Recorded; vm/number/noise_range-inl.h has the other
// types.
// Tested by: tests/vm/number/noise_test.cpp
#if defined(FATHOM_VM_NOISE_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef FATHOM_VM_NOISE_INL
#undef FATHOM_VM_NOISE_INL
#else
#define FATHOM_VM_NOISE_INL
#endif

#include "vm/number/dual-inl.h"
#include "vm/number/noise_bounds.h"

HWY_BEFORE_NAMESPACE();
namespace fathom::vm::HWY_NAMESPACE {

// Returns n modulo 289, in [-144, 144], for an integer n up to 2^22. Exact, because n / 289 is never within 1/578 of
// the middle between two integers, and the f32 product errs by less.
template <class N>
HWY_INLINE N noise_residue(const N& n) {
  return n - round_nearest(n * N::broadcast(1.0 / 289)) * N::broadcast(289.0);
}
// Returns the hash of an integer in [-289, 289].
template <class N>
HWY_INLINE N noise_hash(const N& n) {
  return noise_residue((n * N::broadcast(34.0) + N::broadcast(10.0)) * n);
}

// Computes the hashes of the corners of the cell whose lowest corner is the lattice point (x, y, z). Bits 0, 1 and 2
// of a corner's index are its offsets along x, y and z.
template <class N>
HWY_INLINE void noise_corners(const N& x, const N& y, const N& z, N (&hashes)[8]) {
  const N one = N::broadcast(1.0), rx = noise_residue(x), ry = noise_residue(y), rz = noise_residue(z);
  const N ry1 = ry + one, rz1 = rz + one;
  for (int i = 0; i < 2; ++i) {
    const N along_x = noise_hash(i == 0 ? rx : rx + one);
    for (int j = 0; j < 2; ++j) {
      const N along_y = noise_hash(along_x + (j == 0 ? ry : ry1));
      for (int k = 0; k < 2; ++k) hashes[i + 2 * j + 4 * k] = noise_hash(along_y + (k == 0 ? rz : rz1));
    }
  }
}

// Returns the dot product of (x, y, z) with a corner's direction. The third of the range in which the hash lies
// chooses the coordinate that is left out, the last two bits of the hash the signs.
template <class N, class T>
HWY_INLINE T edge_dot(const N& hash, const T& x, const T& y, const T& z) {
  const N quarter = hash * N::broadcast(0.25), bits = quarter - floor(quarter);  // 0, 1/4, 1/2 or 3/4
  const T a = select(hash < N::broadcast(48.5), x, y), b = select(hash < N::broadcast(-47.5), y, z);
  return select(bits < N::broadcast(0.375), -a, a) +
         select(abs(bits - N::broadcast(0.375)) < N::broadcast(0.25), -b, b);
}

// Returns 6 t^5 - 15 t^4 + 10 t^3, computed without cancellation as t^3 (1 + 3 (1 - t) + 6 (1 - t)^2).
template <class N>
HWY_INLINE N noise_fade(const N& t) {
  const N one = N::broadcast(1.0), s = one - t;
  return t * t * t * (s * (s * N::broadcast(6.0) + N::broadcast(3.0)) + one);
}
// Returns the derivative of noise_fade: 30 t^2 (1 - t)^2.
template <class N>
HWY_INLINE N noise_fade_slope(const N& t) {
  const N s = t * (N::broadcast(1.0) - t);
  return N::broadcast(30.0) * (s * s);
}
template <class N>
HWY_INLINE Dual<N> noise_fade(const Dual<N>& t) {
  return chain(noise_fade(t.v), t, noise_fade_slope(t.v));
}

template <class T>
HWY_INLINE T noise(const T& x, const T& y, const T& z) {
  using N = Constant<T>;
  const N reach = N::broadcast(kNoiseReach), one = N::broadcast(1.0);
  const T px = max(-reach, min(reach, x)), py = max(-reach, min(reach, y)), pz = max(-reach, min(reach, z));
  const N cx = floor(value_of(px)), cy = floor(value_of(py)), cz = floor(value_of(pz));
  N hashes[8];
  noise_corners(cx, cy, cz, hashes);
  const T x0 = px - cx, y0 = py - cy, z0 = pz - cz, x1 = x0 - one, y1 = y0 - one, z1 = z0 - one;
  const T u = noise_fade(x0), v = noise_fade(y0), w = noise_fade(z0);
  const auto mixed = [](const T& a, const T& b, const T& t) HWY_ATTR { return a + (b - a) * t; };
  const auto edge = [&](int first, const T& at_y, const T& at_z) HWY_ATTR {
    return mixed(edge_dot(hashes[first], x0, at_y, at_z), edge_dot(hashes[first + 1], x1, at_y, at_z), u);
  };
  const T near = mixed(edge(0, y0, z0), edge(2, y1, z0), v), far = mixed(edge(4, y0, z1), edge(6, y1, z1), v);
  return mixed(near, far, w);
}

}  // namespace fathom::vm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
