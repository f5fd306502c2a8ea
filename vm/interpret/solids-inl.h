// Definitions of solids that are longer than a line: frames, arcs, polyhedra, periodic surfaces, fractals. The head
// of vm/interpret/operators-inl.h has the rules for all definitions.
#if defined(FATHOM_VM_SOLIDS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef FATHOM_VM_SOLIDS_INL
#undef FATHOM_VM_SOLIDS_INL
#else
#define FATHOM_VM_SOLIDS_INL
#endif

#include <cstdint>

#include "vm/interpret/operators-inl.h"
#include "vm/number/interval-inl.h"
#include "vm/number/number-inl.h"

HWY_BEFORE_NAMESPACE();
namespace fathom::vm::HWY_NAMESPACE {

// Distance from a rectangle, given the signed distances x and y of p beyond its sides.
template <class T>
HWY_INLINE T rectangle(const T& x, const T& y) {
  const Constant<T> zero = constant<T>(0.0);
  return length(max(zero, x), max(zero, y)) + min(zero, max(x, y));
}

// The edges of a box as bars. k: half extents x, y, z of the box, and of the windows between the bars. Outside, the
// distance is that from the nearest of the three bars in p's octant. Inside, the distance is that from the nearest
// empty region: the outside of the box, or one of three shafts through its windows, whose union's outside distance is
// exact. Both parts take a wall's distance from the same difference, so that on the surface, where the first part is
// 0, the second part has the wall's gradient.
template <class T>
HWY_INLINE T box_frame(const Vec3<T>& p, const Constant<T>* k) {
  const Constant<T> zero = constant<T>(0.0);
  const T ax = abs(p.x), ay = abs(p.y), az = abs(p.z);
  const T qx = ax - k[0], qy = ay - k[1], qz = az - k[2];  // beyond the box
  const T vx = ax - k[3], vy = ay - k[4], vz = az - k[5];  // beyond the windows
  const T bx = max(zero, max(qx, -vx)), by = max(zero, max(qy, -vy)), bz = max(zero, max(qz, -vz));
  const T bars =
      min(length(max(zero, qx), by, bz), min(length(bx, max(zero, qy), bz), length(bx, by, max(zero, qz))));
  const T shafts = min(rectangle(vy, vz), min(rectangle(vx, vz), rectangle(vx, vy)));
  return bars + min(zero, max(max(qx, max(qy, qz)), -shafts));
}

// A part of a ring in the xy plane, centred on +y, with round ends. k: major radius, minor radius, sine and cosine of
// the half angle. Exact outside; inside, a lower bound if the ends meet or the hole closes.
template <class T>
HWY_INLINE T capped_torus(const Vec3<T>& p, const Constant<T>* k) {
  const T ax = abs(p.x);
  const T ring = length(length(p.x, p.y) - k[0], p.z);
  const T end = length(ax - k[0] * k[2], p.y - k[0] * k[3], p.z);
  return select(p.y * k[2] < ax * k[3], end, ring) - k[1];
}

// Infinite cone with its apex at the origin, opening downwards. `sine` and `cosine` are those of the half angle.
// Gradient undefined on the axis inside.
template <class T>
HWY_INLINE T infinite_cone(const Vec3<T>& p, Constant<T> sine, Constant<T> cosine) {
  const T rho = length(p.x, p.z);
  const T along = rho * sine - p.y * cosine;  // down the side
  return select(along < constant<T>(0.0), length(p), rho * cosine + p.y * sine);
}

// Regular polyhedra. The mirror planes of the solid's symmetries divide space into chambers, and the surface point
// nearest to p lies in p's chamber. A chamber contains a part of one face, with one edge and one end of that edge. So
// fold p to the chamber of a face, and let `above` be the signed distance from the face's plane, `beyond` that from
// the edge's line within the plane, and `past` that from the edge's end along the edge. k: inradius, the face's own
// inradius, half an edge.
template <class T>
HWY_INLINE T to_face(const T& above, const T& beyond, const T& past) {
  const Constant<T> zero = constant<T>(0.0);
  return select(zero < above, length(above, max(zero, beyond), max(zero, past)), above);
}

// Puts the greater of two numbers first. At a tie both numbers keep their gradients; max and min would both take the
// second's gradient.
template <class T>
HWY_INLINE void order(T& greater, T& lesser) {
  const auto wrong = greater < lesser;
  const T first = select(wrong, lesser, greater);
  lesser = select(wrong, greater, lesser);
  greater = first;
}
HWY_INLINE void order(Interval& greater, Interval& lesser) {
  const Interval first = max(greater, lesser);
  lesser = min(greater, lesser);
  greater = first;
}

// Replaces `most` by `other` and `with` by `with_other` where `other` is greater than `most`.
template <class T>
HWY_INLINE void raise(T& most, T& with, const T& other, const T& with_other) {
  const auto wins = most < other;
  most = select(wins, other, most);
  with = select(wins, with_other, with);
}
HWY_INLINE void raise(Interval& most, Interval& with, const Interval& other, const Interval& with_other) {
  with = select(most < other, with_other, with);
  most = max(most, other);
}

template <class T>
struct Sorted {
  T most, middle, least;
};
template <class T>
HWY_INLINE Sorted<T> sorted(const Vec3<T>& p) {
  Sorted<T> s{p.x, p.y, p.z};
  order(s.most, s.middle);
  order(s.middle, s.least);
  order(s.most, s.middle);
  return s;
}

inline constexpr double kInverseSqrt2 = 0.70710678118654752, kInverseSqrt3 = 0.57735026918962576;
inline constexpr double kInverseSqrt6 = 0.40824829046386302;
inline constexpr double kGolden = 1.6180339887498949, kInverseGolden = 0.6180339887498949;

// Mirrors (a, b) in the plane a + b = 0 to the side where a + b >= 0.
template <class T>
HWY_INLINE void fold(T& a, T& b) {
  const auto behind = a + b < constant<T>(0.0);
  const T folded = select(behind, -b, a);
  b = select(behind, -a, b);
  a = folded;
}

// Tetrahedron with corners (1,1,1), (1,-1,-1), (-1,1,-1), (-1,-1,1), scaled. p is folded to the corner (1,1,1) and
// its face with normal (1,1,-1).
template <class T>
HWY_INLINE T tetrahedron(Vec3<T> p, const Constant<T>* k) {
  fold(p.x, p.y);
  fold(p.x, p.z);
  fold(p.y, p.z);
  const Sorted<T> s = sorted(p);
  const T above = (s.most + s.middle - s.least) * constant<T>(kInverseSqrt3) - k[0];
  const T beyond = (s.most + s.most - s.middle + s.least) * constant<T>(kInverseSqrt6) - k[1];
  return to_face(above, beyond, (s.middle + s.least) * constant<T>(kInverseSqrt2) - k[2]);
}

// Octahedron with corners on the axes.
template <class T>
HWY_INLINE T octahedron(const Vec3<T>& p, const Constant<T>* k) {
  const Sorted<T> s = sorted(Vec3<T>{abs(p.x), abs(p.y), abs(p.z)});
  const T above = (s.most + s.middle + s.least) * constant<T>(kInverseSqrt3) - k[0];
  const T beyond = (s.most + s.middle - s.least - s.least) * constant<T>(kInverseSqrt6) - k[1];
  return to_face(above, beyond, (s.most - s.middle) * constant<T>(kInverseSqrt2) - k[2]);
}

// Rotates (|x|,|y|,|z|) by a multiple of a third of a turn about (1,1,1), which permutes the axes, so that y a + z b
// is largest.
template <class T>
HWY_INLINE Vec3<T> turned(const Vec3<T>& p, Constant<T> a, Constant<T> b) {
  const T x = abs(p.x), y = abs(p.y), z = abs(p.z);
  const T first = y * a + z * b, second = z * a + x * b, third = x * a + y * b;
  const auto second_wins = max(first, third) < second;
  const auto third_wins = first < third;
  return {select(second_wins, y, select(third_wins, z, x)), select(second_wins, z, select(third_wins, x, y)),
          select(second_wins, x, select(third_wins, y, z))};
}

// Dodecahedron with face normal (0, golden ratio, 1), its rotations by turned() and mirror images. The face is a
// regular pentagon in the coordinates (x, up), up = (0, -1, golden ratio) / |.|, with a corner on +up. Only the edges
// at 36, 108 and 180 degrees from +up can be nearest for x >= 0.
template <class T>
HWY_INLINE T dodecahedron(const Vec3<T>& p, const Constant<T>* k) {
  constexpr double kN = 0.52573111211913361;  // 1 / sqrt(1 + golden ratio^2)
  constexpr double kSin36 = 0.58778525229247313, kCos36 = 0.80901699437494742;
  constexpr double kSin108 = 0.95105651629515357, kCos108 = -0.30901699437494742;
  const Vec3<T> q = turned(p, constant<T>(kGolden), constant<T>(1.0));
  const T up = q.z * constant<T>(kGolden * kN) - q.y * constant<T>(kN);
  const T above = q.y * constant<T>(kGolden * kN) + q.z * constant<T>(kN) - k[0];
  T beyond = q.x * constant<T>(kSin36) + up * constant<T>(kCos36);
  T along = abs(q.x * constant<T>(kCos36) - up * constant<T>(kSin36));
  raise(beyond, along, q.x * constant<T>(kSin108) + up * constant<T>(kCos108),
        abs(q.x * constant<T>(kCos108) - up * constant<T>(kSin108)));
  raise(beyond, along, -up, q.x);
  return to_face(above, beyond - k[1], along - k[2]);
}

// Icosahedron with face normals (1,1,1), (0, 1/golden ratio, golden ratio), their rotations by turned() and mirror
// images. A further mirror plane, which exchanges these two normals, folds p to the second. The face is a triangle in
// (x, up), up = (0, -golden ratio, 1/golden ratio) / sqrt 3, with a corner on -up.
template <class T>
HWY_INLINE T icosahedron(const Vec3<T>& p, const Constant<T>* k) {
  const Constant<T> zero = constant<T>(0.0), half = constant<T>(0.5);
  Vec3<T> q = turned(p, constant<T>(kInverseGolden), constant<T>(kGolden));
  const T twice = max(zero, q.x * constant<T>(kGolden) + q.y * constant<T>(kInverseGolden) - q.z);
  q.x = abs(q.x - twice * constant<T>(kGolden / 2));
  q.y = q.y - twice * constant<T>(kInverseGolden / 2);
  q.z = q.z + twice * half;
  const T up = q.z * constant<T>(kInverseGolden * kInverseSqrt3) - q.y * constant<T>(kGolden * kInverseSqrt3);
  const T above =
      q.y * constant<T>(kInverseGolden * kInverseSqrt3) + q.z * constant<T>(kGolden * kInverseSqrt3) - k[0];
  const Constant<T> sin120 = constant<T>(1.5 * kInverseSqrt3);
  T beyond = q.x * sin120 - up * half, along = abs(q.x * half + up * sin120);
  raise(beyond, along, up, q.x);
  return to_face(above, beyond - k[1], along - k[2]);
}

// Pyramid with a square base and an apex above its middle. k: half width, half height; a side's outward normal (nx,
// ny); the normal (mx, my) of a side's edge in the side's plane, and that edge's length. p is folded to one half of a
// side. Inside, the distance is that from the nearer of the side's and the base's plane. Outside, the distance is
// that from the nearer of the side's triangle and the base's square; the base accounts for the triangle's lower edge.
template <class T>
HWY_INLINE T pyramid(const Vec3<T>& p, const Constant<T>* k) {
  const Constant<T> zero = constant<T>(0.0);
  T x = abs(p.x), z = abs(p.z);
  order(x, z);
  const T qx = x - k[0], qy = p.y + k[1], qz = z - k[0];  // from the base's corner
  const T side = qx * k[2] + qy * k[3];
  const T up = qy * k[2] - qx * k[3];  // up the side, from its lower edge
  const T beyond = qz * k[4] + up * k[5];
  const T along = up * k[4] - qz * k[5];  // along the edge, from the base's corner
  const T past = along - max(zero, min(k[6], along));
  const T to_base = sqr(max(zero, qx)) + sqr(qy) + sqr(max(zero, qz));
  const T to_side = sqr(side) + sqr(max(zero, beyond)) + sqr(past);
  const T outside = sqrt(select(up < zero, to_base, min(to_base, to_side)));
  const T inside = max(side, -qy);
  // `outside` can be 0 by rounding, as in cone_profile().
  return select(zero < inside, max(outside, inside), inside);
}

// Triply periodic surfaces: functions of the angles k p, negative inside the solid. Their Lipschitz constants are
// sqrt 3 k, which is attained where all angles are 0 (gyroid, Schwarz D) or a quarter turn (Schwarz P). These points
// are on the surface.
//
// Gyroid (Schoen 1970; this approximation is the usual one): a partial derivative cos x cos y - sin z sin x is at
// most sqrt(cos^2 y + sin^2 z) by Cauchy's inequality, and the squares of these three bounds add up to 3.
template <class T>
HWY_INLINE T gyroid(const Vec3<T>& p, Constant<T> k) {
  const T x = p.x * k, y = p.y * k, z = p.z * k;
  return sin(x) * cos(y) + sin(y) * cos(z) + sin(z) * cos(x);
}
template <class T>
HWY_INLINE T schwarz_p(const Vec3<T>& p, Constant<T> k) {
  return cos(p.x * k) + cos(p.y * k) + cos(p.z * k);
}
// Schwarz D is half the sum of the sines of x+y-z, x-y+z, -x+y+z and x+y+z. The square of its gradient's length is
// sum c_i^2 - (sum c_i)^2 / 4, where c_i are the cosines of four angles whose sum is half a turn (the last is
// negated). Let p and pi/2 - p be the half sums of two pairs of these angles, C = cos p, S = sin p, and u, v the
// cosines of the pairs' half differences. Then the square is 2 + (C u - S v)^2 - 2 (C v)^2 - 2 (S u)^2. On |u|, |v|
// <= 1 the quadratic form after the 2 is largest on the border: at a corner at most 0, on a side u = 1 at most 3 C^2
// - 2 + C^2 S^2 / (3 C^2 - 1) with C^2 >= 1/2, hence at most 1. So the square is at most 3.
template <class T>
HWY_INLINE T schwarz_d(const Vec3<T>& p, Constant<T> k) {
  const T x = p.x * k, y = p.y * k, z = p.z * k;
  return sin(x) * cos(y - z) + cos(x) * sin(y + z);
}

// Karl Menger's sponge of 1926: a cube whose faces' middle squares, of a third of the width, are cut all the way
// through, repeated in the remaining cubes of a third of the width. abs and min fold p into the cube of each level, a
// continuous nonexpansive map. The middle one of the folded coordinates is the distance from the nearest hole's axis
// in the maximum norm. The result is a lower bound outside and in the holes.
template <class T>
HWY_INLINE T menger_sponge(const Vec3<T>& p, Constant<T> half_size, std::uint32_t iterations) {
  const Constant<T> third = constant<T>(1.0 / 3);
  T d = box(p, half_size, half_size, half_size);
  Vec3<T> q{abs(p.x), abs(p.y), abs(p.z)};
  Constant<T> hole = half_size * third;
  for (std::uint32_t i = 0; i < iterations; ++i) {
    d = max(d, hole - sorted(q).middle);
    const Constant<T> next = hole + hole;
    q = {min(q.x, abs(q.x - next)), min(q.y, abs(q.y - next)), min(q.z, abs(q.z - next))};
    hole = hole * third;
  }
  return d;
}

// The slice through 1, i, j of the filled Julia set of q -> q^2 + c in the quaternions (Norton, "Generation and
// display of geometric fractals in 3-D", 1982). k: c. `bound`: radius from beyond which no orbit returns. `bailout`:
// radius at which the iteration stops. The surface lies where the last point of the orbit has the radius `bound`. The
// estimate is that of Hart, Sandin & Kauffman, "Ray Tracing Deterministic 3-D Fractals", 1989, with the logarithm of
// |q| / bound. The ball of radius `bound` contains the set, so the result is at least the distance from that ball,
// and exactly this distance far out. The estimate is not a bound: neither certified nor Lipschitz.
template <class T>
HWY_INLINE T julia(const Vec3<T>& p, std::uint32_t iterations, const Constant<T>* k, Constant<T> bound,
                   Constant<T> bailout) {
  const Constant<T> zero = constant<T>(0.0), tiny = constant<T>(1e-30), huge = constant<T>(1e30);
  const Constant<T> bailout2 = bailout * bailout;
  T a = p.x, b = p.y, c = p.z, d = p.x * zero;
  T m = sqr(a) + sqr(b) + sqr(c);
  const T from_ball = sqrt(m) - bound;
  T slope = d + constant<T>(1.0);
  for (std::uint32_t i = 0; i < iterations; ++i) {
    const auto active = m < bailout2;
    if (!any(active)) break;
    const T r = sqrt(m), twice = a + a;
    slope = select(active, min(huge, (r + r) * slope), slope);
    a = select(active, sqr(a) - (sqr(b) + sqr(c) + sqr(d)) + k[0], a);
    b = select(active, twice * b + k[1], b);
    c = select(active, twice * c + k[2], c);
    d = select(active, twice * d + k[3], d);
    m = sqr(a) + sqr(b) + sqr(c) + sqr(d);
  }
  m = max(tiny, m);
  const T estimate = log(m * (constant<T>(1.0) / (bound * bound))) * sqrt(m) / max(tiny, slope) * constant<T>(0.25);
  return select(bound < from_ball, from_ball, max(from_ball, estimate));
}

}  // namespace fathom::vm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
