// Definitions of the outlines' opcodes: signed distances in the xy plane, z ignored. The head of
// vm/interpret/operators-inl.h has the rules for all definitions.
//
// All are exact and 1-Lipschitz outside, and also inside unless stated otherwise. Shapes with a mirror axis at x = 0
// are folded onto x >= 0 first, because the nearest point of a symmetric boundary is on p's side. If p's nearest
// point lies inside a straight or round piece of the boundary, the distance is that from the whole line or circle,
// which has a unit gradient and the right sign even on the boundary. Only beyond a piece's end is the distance a root
// of squares, whose gradient vanishes at 0. The inside of a corner follows from the shape, never from a computed
// sign. Cases after Inigo Quilez, "2D distance functions" (iquilezles.org), derived anew. Sines, normals and lengths
// come as immediates from compiler/shapes/outlines.cpp. Tested by: tests/compiler/shapes/shapes_test.cpp
#if defined(FATHOM_VM_OUTLINES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef FATHOM_VM_OUTLINES_INL
#undef FATHOM_VM_OUTLINES_INL
#else
#define FATHOM_VM_OUTLINES_INL
#endif

#include "vm/interpret/operators-inl.h"

HWY_BEFORE_NAMESPACE();
namespace fathom::vm::HWY_NAMESPACE {

inline constexpr double kHalfSqrt2 = 0.70710678118654752;

// Returns the signed part of `along` beyond [begin, end], exactly 0 inside.
template <class T>
HWY_INLINE T beyond_segment(const T& along, Constant<T> begin, Constant<T> end) {
  return along - max(begin, min(end, along));
}

// Returns `face` if the nearest point lies inside a piece, `corner` if it lies `beyond` the piece's end. Less than
// 1e-15 beyond counts as inside, because such squares vanish in float, and the gradient with them.
template <class T>
HWY_INLINE T face_or_corner(const T& beyond, const T& face, const T& corner) {
  return select(constant<T>(1e-30) < sqr(beyond), corner, face);
}

// Distance from a piece whose ends are convex corners; `face` is the distance from its line.
template <class T>
HWY_INLINE T convex_edge(const T& face, const T& beyond) {
  return face_or_corner(beyond, face, length(face, beyond));
}

template <class T>
HWY_INLINE T rectangle(const Vec3<T>& p, Constant<T> x, Constant<T> y) {
  const Constant<T> zero = constant<T>(0.0);
  const T qx = abs(p.x) - x, qy = abs(p.y) - y;
  return length(max(zero, qx), max(zero, qy)) + min(zero, max(qx, qy));
}

// k: one end x y, unit direction to the other end, length, thickness. Gradient undefined on the segment.
template <class T>
HWY_INLINE T segment(const Vec3<T>& p, const Constant<T>* k) {
  const T x = p.x - k[0], y = p.y - k[1];
  const T along = x * k[2] + y * k[3], across = x * k[3] - y * k[2];
  return length(across, beyond_segment(along, constant<T>(0.0), k[4])) - k[5];
}

// Folds the plane onto the sector between +y and the mirror axis at 180 / n degrees from it, towards +x, for shapes
// with the symmetry of a regular n-gon. k: six unit normals (x, y) of mirror lines, (0, 0) for lines that are not
// needed. Each mirror line halves the remaining angle, so six suffice for 64 sides.
template <class T>
HWY_INLINE Vec3<T> fold_to_sector(const Vec3<T>& p, const Constant<T>* k) {
  T x = abs(p.x), y = p.y;
  for (int i = 0; i < 6; ++i) {
    const Constant<T> nx = k[2 * i], ny = k[2 * i + 1];
    const T behind = min(constant<T>(0.0), x * nx + y * ny);
    const T twice = behind + behind;
    x = x - twice * nx;
    y = y - twice * ny;
  }
  return {x, y, p.z};
}

// k: six normals for fold_to_sector, the edge's unit normal, circumradius. Gradient undefined on the lines from the
// corners to the centre.
template <class T>
HWY_INLINE T regular_polygon(const Vec3<T>& p, const Constant<T>* k) {
  const Vec3<T> q = fold_to_sector(p, k);
  const T y = q.y - k[14];  // from the corner
  const T face = q.x * k[12] + y * k[13], along = q.x * k[13] - y * k[12];
  return convex_edge(face, min(constant<T>(0.0), along));
}

// k: six normals for fold_to_sector, unit direction from a tip to the inner corner, distance between these, radius,
// sign of the inner corner. The sign is a large positive number for a convex inner corner, a large negative number
// for a concave one, and 0 for a nearly flat one, where p's side of the edge gives the sign.
template <class T>
HWY_INLINE T star(const Vec3<T>& p, const Constant<T>* k) {
  const Constant<T> zero = constant<T>(0.0);
  const Vec3<T> q = fold_to_sector(p, k);
  const T y = q.y - k[15];
  const T face = y * k[12] - q.x * k[13], along = q.x * k[12] + y * k[13];
  const T beyond = beyond_segment(along, zero, k[14]);
  const T corner = length(face, beyond);
  return face_or_corner(beyond, face, select(along < zero, corner, select(face + k[16] < zero, -corner, corner)));
}

// k: as in cone_profile.
template <class T>
HWY_INLINE T trapezoid(const Vec3<T>& p, const Constant<T>* k) {
  return cone_profile(abs(p.x), p.y, k);
}
// k: as in cone_profile, then y of the middle.
template <class T>
HWY_INLINE T isosceles_triangle(const Vec3<T>& p, const Constant<T>* k) {
  return cone_profile(abs(p.x), p.y - k[6], k);
}

// k: half width, half height, skew, outward unit normal of the right side, half the side's length. The shape is point
// symmetric, so the side on p's half is measured. Inside and outside as in cone_profile.
template <class T>
HWY_INLINE T parallelogram(const Vec3<T>& p, const Constant<T>* k) {
  const Constant<T> zero = constant<T>(0.0);
  const T across = p.x * k[3] + p.y * k[4];
  const auto left = across < zero;
  const T x = select(left, -p.x, p.x) - k[0], y = select(left, -p.y, p.y);  // from the right side's middle
  const T side = x * k[3] + y * k[4];
  const T beyond_side = beyond_segment(y * k[3] - x * k[4], -k[5], k[5]);
  const T cap = abs(p.y) - k[1];
  const T beyond_cap = beyond_segment(select(p.y < zero, -p.x, p.x) - k[2], -k[0], k[0]);
  const T outside = sqrt(min(sqr(side) + sqr(beyond_side), sqr(cap) + sqr(beyond_cap)));
  const T inside = max(side, cap);
  return select(zero < inside, max(outside, inside), inside);
}

// k: unit normal, offset of the edge's line, half width, the edge's length.
template <class T>
HWY_INLINE T diamond(const Vec3<T>& p, const Constant<T>* k) {
  const T x = abs(p.x), y = abs(p.y);
  const T along = y * k[0] - (x - k[3]) * k[1];  // from the corner on the x axis
  return convex_edge(x * k[0] + y * k[1] - k[2], beyond_segment(along, constant<T>(0.0), k[4]));
}

// k: as in round_cone_profile.
template <class T>
HWY_INLINE T uneven_capsule(const Vec3<T>& p, const Constant<T>* k) {
  return round_cone_profile(abs(p.x), p.y, k);
}

// A point in the frame of a ray from the origin, given by sine and cosine of its angle from +y. `past`: signed
// distance from the ray's line, positive at larger angles. `out`: coordinate along the ray.
template <class T>
struct RayFrame {
  T past, out;
};
template <class T>
HWY_INLINE RayFrame<T> ray_frame(const T& x, const T& y, Constant<T> sine, Constant<T> cosine) {
  return {x * cosine - y * sine, x * sine + y * cosine};
}

// k: radius, thickness, sine and cosine of half the aperture, the end x y. Inside, exact if the round ends do not
// overlap, else a lower bound. Gradient undefined on the arc.
template <class T>
HWY_INLINE T arc(const Vec3<T>& p, const Constant<T>* k) {
  const T x = abs(p.x);
  const T past = ray_frame(x, p.y, k[2], k[3]).past;
  const T to_end = length(x - k[4], p.y - k[5]), to_circle = abs(length(p.x, p.y) - k[0]);
  return select(constant<T>(0.0) < past, to_end, to_circle) - k[1];
}

// Cuts off the shape of distance `body` along a ray. The flat end extends from `begin` to `end` on the ray.
template <class T>
HWY_INLINE T cut_by_ray(const RayFrame<T>& f, const T& body, Constant<T> begin, Constant<T> end) {
  const Constant<T> zero = constant<T>(0.0);
  const T beyond = beyond_segment(f.out, begin, end);
  const T corner = length(f.past, beyond);
  const T cut = face_or_corner(beyond, f.past, select(f.past < zero, -corner, corner));
  return select(zero < f.past, cut, max(body, cut));
}
// k: radius, thickness, sine and cosine of half the aperture (below 180 degrees), inner and outer radius.
template <class T>
HWY_INLINE T ring(const Vec3<T>& p, const Constant<T>* k) {
  const T band = abs(length(p.x, p.y) - k[0]) - k[1];
  return cut_by_ray(ray_frame(abs(p.x), p.y, k[2], k[3]), band, k[4], k[5]);
}
// k: radius, sine and cosine of half the aperture (below 180 degrees).
template <class T>
HWY_INLINE T pie(const Vec3<T>& p, const Constant<T>* k) {
  const T disc = length(p.x, p.y) - k[0];
  return cut_by_ray(ray_frame(abs(p.x), p.y, k[1], k[2]), disc, constant<T>(0.0), k[0]);
}

// k: radius, height, half the chord. The corner is nearest for a p outside the chord's width and above the radius
// that leads to the corner.
template <class T>
HWY_INLINE T cut_disk(const Vec3<T>& p, const Constant<T>* k) {
  const Constant<T> zero = constant<T>(0.0);
  const T x = abs(p.x), above = p.y - k[1];
  const T body = max(length(p.x, p.y) - k[0], above);
  const T outside = max(length(max(zero, x - k[2]), above), body);
  return select(zero < x * k[1] - p.y * k[2], body, select(zero < body, outside, body));
}

// k: radius, thickness, sine and cosine of half the aperture, length of the legs, inner and outer radius. The legs
// continue the arc's ends as straight lines.
template <class T>
HWY_INLINE T horseshoe(const Vec3<T>& p, const Constant<T>* k) {
  const Constant<T> zero = constant<T>(0.0);
  const RayFrame<T> f = ray_frame(abs(p.x), p.y, k[2], k[3]);
  const T to_end = f.past - k[4], aside = abs(f.out - k[0]) - k[1];
  const T leg = length(max(zero, to_end), max(zero, aside)) + min(zero, max(to_end, aside));
  const T band = abs(length(p.x, p.y) - k[0]) - k[1];
  const T beyond = beyond_segment(f.out, k[5], k[6]);
  return select(zero < f.past, leg, max(band, face_or_corner(beyond, to_end, -length(to_end, beyond))));
}

// k: half height h, centre's offset c, radius r of the right side's circle about (-c, 0), the tip's unit normal. The
// distance from the circle is computed as (|p|^2 - h^2 + 2 c x) / (|p - centre| + r), using c^2 - r^2 = -h^2. A slim
// lens has c and r far larger than itself, which would cancel in |p - centre| - r.
template <class T>
HWY_INLINE T lens(const Vec3<T>& p, const Constant<T>* k) {
  const T x = abs(p.x), y = abs(p.y), above = y - k[0];
  const T side = (x * (x + k[1] + k[1]) + above * (y + k[0])) / (length(x + k[1], y) + k[2]);
  return select(constant<T>(0.0) < above * k[3] - x * k[4], length(x, above), side);
}

// k: radius, cut radius, distance, the corner x y, unit normals at the corner of the disk and of the cut. The corner
// is nearest for a p between these normals.
template <class T>
HWY_INLINE T moon(const Vec3<T>& p, const Constant<T>* k) {
  const Constant<T> zero = constant<T>(0.0);
  const T x = abs(p.x);
  const T dx = x - k[3], dy = p.y - k[4];
  const T body = max(length(p.x, p.y) - k[0], k[1] - length(p.x, p.y - k[2]));
  const auto past_disk = zero < p.y * k[5] - x * k[6];
  const auto past_cut = zero < dx * k[8] - dy * k[7];
  return select(past_disk, select(past_cut, length(dx, dy), body), body);
}

// k: bottom radius, top radius, height, centre's offset c, radius r of the right side's circle about (-c, 0), the
// unit normal where it meets the top. The side's distance is computed as in lens, using r = c + bottom radius.
template <class T>
HWY_INLINE T egg(const Vec3<T>& p, const Constant<T>* k) {
  const Constant<T> zero = constant<T>(0.0);
  const T x = abs(p.x), above = p.y - k[2];
  const T side = ((x - k[0]) * (x + k[4] + k[3]) + sqr(p.y)) / (length(x + k[3], p.y) + k[4]);
  const T top = select(zero < above * k[5] - x * k[6], length(p.x, above) - k[1], side);
  return select(p.y < zero, length(p.x, p.y) - k[0], top);
}

// k: size. Two straight sides at 45 degrees meet at the origin. Two half circles on the upper sides of a square meet
// in the notch at (0, size).
template <class T>
HWY_INLINE T heart(const Vec3<T>& p, const Constant<T>* k) {
  const T x = abs(p.x), sum = x + p.y;
  const Constant<T> quarter = k[0] * constant<T>(0.25), diagonal = constant<T>(kHalfSqrt2);
  const T round = length(x - quarter, p.y - k[0] * constant<T>(0.75)) - k[0] * constant<T>(kHalfSqrt2 / 2);
  const T side = convex_edge((x - p.y) * diagonal, min(constant<T>(0.0), sum * diagonal));
  return select(sum < k[0], max(side, -length(x, p.y - k[0])), round);
}

// k: half length, half width of the arms. Inside, the arms' sides end at the inner corner.
template <class T>
HWY_INLINE T cross(const Vec3<T>& p, const Constant<T>* k) {
  const Constant<T> zero = constant<T>(0.0);
  const T ax = abs(p.x), ay = abs(p.y);
  // At a tie max and min return their second operand. The order differs, so that `hi` and `side` get different
  // operands.
  const T hi = max(ax, ay), end = hi - k[0], side = min(ay, ax) - k[1];
  const T body = max(end, side);
  const T outside = max(length(max(zero, end), max(zero, side)), body);
  const T before = max(zero, k[1] - hi);
  return select(zero < body, outside, max(end, face_or_corner(before, side, -length(side, before))));
}

// k: radius of the arms, distance of their ends from the origin. Gradient undefined on the arms' middle lines.
template <class T>
HWY_INLINE T rounded_x(const Vec3<T>& p, const Constant<T>* k) {
  const Constant<T> diagonal = constant<T>(kHalfSqrt2);
  const T ax = abs(p.x), ay = abs(p.y);
  const T along = (ax + ay) * diagonal, across = abs(ax - ay) * diagonal;
  const T arm = length(max(constant<T>(0.0), along - k[1]), across) - k[0];
  return select(along < k[0], -length(k[0] - along, k[0] - across), arm);
}

// k: larger radius a, smaller radius b, a^2 - b^2, 1 when y is the long axis and 0 when x is.
//
// The distance from a convex shape, inside and outside, is the maximum over all unit normals n of <p, n> - h(n),
// where h is the support function, here |(a nx, b ny)|. So every n gives a lower bound, and an error of n enters
// squared. The best normal is along (x / v, y / u), v = u + a^2 - b^2, with u such that s = (a x / v, b y / u) has
// length 1 (Lagrange; u = b^2 on the ellipse). 1 / |s| is concave in u > 0 (More & Sorensen, "Computing a Trust
// Region Step", 1983), so Newton's method on 1 / |s| = 1 climbs to the root from any smaller u without passing the
// root. The iteration starts at the u for which the larger component of s is 1. Convergence is slowest near the ends
// of the evolute, where kEllipseSteps leave an error of 1e-16. A y of 0 counts as 1e-15, so that u > 0. Gradient
// undefined on the long axis between the evolute's ends. Elsewhere the gradient is n, because the derivative of n
// contributes nothing at the maximum.
inline constexpr int kEllipseSteps = 24;
template <class C>
struct Direction {
  C x, y;
};
template <class C>
HWY_INLINE Direction<C> ellipse_normal(const C& x, const C& y, C major, C minor, C focal) {
  const C one = constant<C>(1.0), above = max(constant<C>(1e-15), y);
  const C sx = x * major, sy = above * minor;
  C u = max(sy, sx - focal);
  for (int i = 0; i < kEllipseSteps; ++i) {
    const C v = u + focal;
    const C px = sqr(sx / v), py = sqr(sy / u);
    const C squares = px + py, size = sqrt(squares);
    const auto active = constant<C>(1 + 1e-8) < size;
    if (!any(active)) break;
    u = select(active, u + squares * (size - one) / (px / v + py / u), u);
  }
  const C along = x * u / (u + focal), scale = length(along, above);
  return {along / scale, above / scale};
}
template <class T>
HWY_INLINE T ellipse(const Vec3<T>& p, const Constant<T>* k) {
  using C = Constant<T>;
  const auto upright = constant<T>(0.0) < k[3];
  const T ax = abs(p.x), ay = abs(p.y);
  const T x = select(upright, ay, ax), y = select(upright, ax, ay);
  const Direction<C> n = ellipse_normal<C>(value_of(x), value_of(y), k[0], k[1], k[2]);
  return x * n.x + y * n.y - length(n.x * k[0], n.y * k[1]);
}

// The distance from a convex shape with both axes as mirror axes grows with |x| and with |y|. So its range is given
// by the values at the nearest and the farthest corner, each with its rounding error. Interval arithmetic would give
// no useful bounds of the iteration above.
HWY_INLINE Interval ellipse(const Vec3<Interval>& p, const Interval* k) {
  const Interval x = abs(p.x), y = abs(p.y);
  if (!(std::isfinite(x.hi) && std::isfinite(y.hi))) return whole_line();
  Real middle[4];
  for (int i = 0; i < 4; ++i) middle[i] = {0.5 * (k[i].lo + k[i].hi)};
  const auto at = [&](double px, double py) HWY_ATTR { return ellipse(Vec3<Real>{{px}, {py}, {0}}, middle).v; };
  const double slack = 1e-14 * (x.hi + y.hi + k[0].hi);
  return outward(at(x.lo, y.lo) - slack, at(x.hi, y.hi) + slack);
}

HWY_INLINE Along ellipse(const Vec3<Along>& p, const Along* k) {
  Interval of[4];
  for (int i = 0; i < 4; ++i) of[i] = k[i].v;
  return at_most(ellipse(Vec3<Interval>{p.x.v, p.y.v, p.z.v}, of), length(p.x.d, p.y.d).hi);
}

}  // namespace fathom::vm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
