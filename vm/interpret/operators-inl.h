// Definitions of the opcodes that are longer than a line (vm/program/opcodes.def), over any number type of
// vm/number/: basic solids, polygons, the Mandelbulb and blends. Others are in vm/interpret/solids-inl.h,
// vm/interpret/outlines-inl.h and vm/interpret/domain-inl.h.
//
// T is the number type, C its constants. Each shape states where its gradient is undefined; there the derivative is
// that of the branch taken, or zero. All shapes are 1-Lipschitz and exact inside and outside unless stated otherwise.
// Formulas after Inigo Quilez, "Distance functions" (iquilezles.org), corrected where the gradient or the sign
// failed, with derivations in the comments.
// Tested by: tests/compiler/shapes/shapes_test.cpp, tests/vm/number/operators_test.cpp
#if defined(FATHOM_VM_OPERATORS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef FATHOM_VM_OPERATORS_INL
#undef FATHOM_VM_OPERATORS_INL
#else
#define FATHOM_VM_OPERATORS_INL
#endif

#include <algorithm>
#include <cstdint>

#include "vm/number/along-inl.h"
#include "vm/number/batch-inl.h"
#include "vm/number/convexity-inl.h"
#include "vm/number/dual-inl.h"
#include "vm/number/interval_elementary-inl.h"
#include "vm/number/noise-inl.h"
#include "vm/number/noise_range-inl.h"
#include "vm/number/number-inl.h"
#include "vm/number/real-inl.h"
#include "vm/number/slope_elementary-inl.h"
#include "vm/number/tagged-inl.h"
#include "vm/program/opcode.h"

HWY_BEFORE_NAMESPACE();
namespace fathom::vm::HWY_NAMESPACE {

template <class T>
HWY_INLINE T length(const Vec3<T>& p) {
  return length(p.x, p.y, p.z);
}

template <class T>
HWY_INLINE Vec3<T> subtract(const Vec3<T>& p, Constant<T> x, Constant<T> y, Constant<T> z) {
  return {p.x - x, p.y - y, p.z - z};
}

// Converts a constant to the type of the first argument.
template <class N>
HWY_INLINE N as_value(const N&, N k) {
  return k;
}
template <class N>
HWY_INLINE Dual<N> as_value(const Dual<N>&, N k) {
  return no_derivative(k);
}

// Returns one row of m * (p, 1), where m is a row-major 3x4 matrix.
template <class T>
HWY_INLINE T affine_row(const Vec3<T>& p, const Constant<T>* m) {
  return p.x * m[0] + p.y * m[1] + p.z * m[2] + m[3];
}
template <class T>
HWY_INLINE Vec3<T> affine(const Vec3<T>& p, const Constant<T>* m) {
  return {affine_row(p, m), affine_row(p, m + 4), affine_row(p, m + 8)};
}

// Box of half extents x, y, z. Gradient undefined on the edges and on the medial planes inside. The order of min's
// and max's operands matters: on the surface both terms are 0, and the tie must go to the operand that has a
// gradient.
template <class T>
HWY_INLINE T box(const Vec3<T>& p, Constant<T> x, Constant<T> y, Constant<T> z) {
  const Constant<T> zero = constant<T>(0.0);
  const T qx = abs(p.x) - x, qy = abs(p.y) - y, qz = abs(p.z) - z;
  return length(max(zero, qx), max(zero, qy), max(zero, qz)) + min(zero, max(qx, max(qy, qz)));
}

// Cylinder about the y axis.
template <class T>
HWY_INLINE T cylinder(const Vec3<T>& p, Constant<T> radius, Constant<T> half_height) {
  const Constant<T> zero = constant<T>(0.0);
  const T dx = length(p.x, p.z) - radius, dy = abs(p.y) - half_height;
  return length(max(zero, dx), max(zero, dy)) + min(zero, max(dx, dy));
}

// k: half height, bottom radius, top radius, the side's outward normal (nx, ny) in the half-plane (distance from the
// axis, y), the side's length. Inside, the distance is the maximum of the planes' distances, because the profile is
// convex. Outside, the distance is that from the nearer of the side's segment and the near cap's disc. Unlike
// sign * sqrt(squares), these branches keep a unit gradient on the surface, where the planes' branch is taken.
template <class T>
HWY_INLINE T cone_profile(const T& rho, const T& y, const Constant<T>* k) {
  const Constant<T> zero = constant<T>(0.0);
  const T qx = rho - k[1], qy = y + k[0];  // from the bottom rim
  const T side = qx * k[3] + qy * k[4];    // distance to the side's line
  const T along = qy * k[3] - qx * k[4];   // from the bottom rim up the side
  const T beyond = along - max(zero, min(k[5], along));
  const T cap = abs(y) - k[0];
  const T past_rim = max(zero, rho - select(y < zero, k[1], k[2]));
  const T outside = sqrt(min(sqr(side) + sqr(beyond), sqr(past_rim) + sqr(cap)));
  const T inside = max(side, cap);
  // `outside` is never less than `inside` in exact arithmetic. On a rim, rounding can make `outside` 0, without a
  // gradient, where `inside` is positive.
  return select(zero < inside, max(outside, inside), inside);
}
template <class T>
HWY_INLINE T cone(const Vec3<T>& p, const Constant<T>* k) {
  return cone_profile(length(p.x, p.z), p.y, k);
}

// Hull of two balls. k: bottom radius, top radius, height, the side's outward normal (nx, ny) in the half-plane
// (distance from the axis, y). Gradient undefined at the balls' centres and on the axis inside.
template <class T>
HWY_INLINE T round_cone_profile(const T& rho, const T& y, const Constant<T>* k) {
  const Constant<T> zero = constant<T>(0.0);
  const T along = y * k[3] - rho * k[4];  // position along the side, 0 at the lower ball
  const T lower = length(rho, y) - k[0];
  const T upper = length(rho, y - k[2]) - k[1];
  const T side = rho * k[3] + y * k[4] - k[0];
  return select(along < zero, lower, select(k[3] * k[2] < along, upper, side));
}
template <class T>
HWY_INLINE T round_cone(const Vec3<T>& p, const Constant<T>* k) {
  return round_cone_profile(length(p.x, p.z), p.y, k);
}

// A flat convex polygon of N corners with a thickness. k: 12 numbers of the affine map that puts the polygon into the
// xy plane with its first edge on the x axis, corners counter-clockwise; the first edge's length; per further edge
// its start x y, its direction ux uy and its length; the thickness. The distance from the flat polygon is |z| above
// its inside and the distance from the nearest edge elsewhere. Gradient undefined in the polygon's plane.
template <int N, class T>
HWY_INLINE T sheet(const Vec3<T>& p, const Constant<T>* k) {
  const Constant<T> zero = constant<T>(0.0);
  const Vec3<T> q = affine(p, k);
  T outward = -q.y;  // maximum signed distance from an edge's line
  T nearest = sqr(q.y) + sqr(q.x - max(zero, min(k[12], q.x)));
  for (int i = 1; i < N; ++i) {
    const Constant<T>* edge = k + 13 + 5 * (i - 1);
    const T wx = q.x - edge[0], wy = q.y - edge[1];
    const T along = wx * edge[2] + wy * edge[3], across = wx * edge[3] - wy * edge[2];
    const T beyond = along - max(zero, min(edge[4], along));
    nearest = min(nearest, sqr(across) + sqr(beyond));
    outward = max(outward, across);
  }
  const T aside = select(zero < outward, nearest, q.x * zero);
  return sqrt(aside + sqr(q.z)) - k[13 + 5 * (N - 1)];
}

// Index of the corner after i, and the polygon's orientation: 1 if the corners are counter-clockwise, else -1.
template <class Outline>
HWY_INLINE std::size_t next_corner(const Outline& corners, std::size_t i) {
  return i + 1 == corners.count() ? 0 : i + 1;
}
template <class Outline>
HWY_INLINE double polygon_sense(const Outline& corners) {
  double area = 0;  // relative to the first corner, for accuracy far from the origin
  for (std::size_t i = 0; i < corners.count(); ++i) {
    const std::size_t j = next_corner(corners, i);
    area += (corners(i, 0) - corners(0, 0)) * (corners(j, 1) - corners(0, 1)) -
            (corners(j, 0) - corners(0, 0)) * (corners(i, 1) - corners(0, 1));
  }
  return area < 0 ? -1 : 1;
}

// A simple polygon in the xy plane, corners (x, y) in either order; z is ignored. Exact. Gradient undefined at the
// corners and on the medial axis.
//
// For each edge, `across` is the signed distance from its line, positive to the right, and `beyond` the distance past
// its nearer end. If the nearest point lies inside an edge, nothing lies between p and that edge, so the distance is
// |across| without a square root, and p's side of the edge tells inside from outside. On the outline, `across` keeps
// the unit gradient that sign * sqrt(squares) loses. Off the outline and past an edge's end, the sign is the parity
// of the edges to the right of p instead (an edge includes its lower end but not its upper end): rounding may take
// the far edge of a thin spike for the nearest, and p is on the other side of that edge.
template <class T, class Outline>
HWY_INLINE T polygon(const Vec3<T>& p, const Outline& corners) {
  using C = Constant<T>;
  const C zero = constant<T>(0.0), one = constant<T>(1.0);
  C side = one;
  double longest = 0;
  T nearest = as_value(p.x, constant<T>(std::numeric_limits<float>::max())), offset = nearest, past = nearest;
  for (std::size_t i = 0; i < corners.count(); ++i) {
    const std::size_t j = next_corner(corners, i);
    const double ex = corners(j, 0) - corners(i, 0), ey = corners(j, 1) - corners(i, 1);
    const double length = std::sqrt(ex * ex + ey * ey);
    if (!(length > 0)) continue;
    longest = std::max(longest, length);
    const C ux = constant<T>(ex / length), uy = constant<T>(ey / length);
    const T wx = p.x - corners.constant(i, 0), wy = p.y - corners.constant(i, 1);
    const T along = wx * ux + wy * uy, across = wx * uy - wy * ux;
    const T beyond = max(zero, max(-along, along - constant<T>(length)));
    const T square = sqr(across) + sqr(beyond);
    const auto nearer = square < nearest;
    nearest = select(nearer, square, nearest);
    offset = select(nearer, across, offset);
    past = select(nearer, beyond, past);
    const C flipped = select((ey > 0 ? across : -across) < zero, -side, side);
    side = select(p.y < corners.constant(ey > 0 ? i : j, 1), side,
                  select(p.y < corners.constant(ey > 0 ? j : i, 1), flipped, side));
  }
  const C on_outline = constant<T>(0x1p-21 * longest);  // at most the float error of an edge's line
  const T inner = select(on_outline < abs(offset), abs(offset) * side, offset * constant<T>(polygon_sense(corners)));
  return select(past > zero, sqrt(nearest) * side, inner);
}
// Range by the Lipschitz constant 1: the distance at the box's middle plus or minus half the diagonal. The slack far
// outweighs the rounding error at the middle.
template <class Outline>
HWY_INLINE Interval polygon(const Vec3<Interval>& p, const Outline& corners) {
  const Real x{(p.x.lo + p.x.hi) / 2}, y{(p.y.lo + p.y.hi) / 2};
  double scale = std::fabs(x.v) + std::fabs(y.v);
  for (std::size_t i = 0; i < corners.count(); ++i) {
    scale = std::max(scale, std::fabs(corners(i, 0)) + std::fabs(corners(i, 1)));
  }
  const double middle = polygon(Vec3<Real>{x, y, {0}}, corners.real()).v;
  const double reach = length(Interval{0, (p.x.hi - p.x.lo) / 2}, Interval{0, (p.y.hi - p.y.lo) / 2}).hi;
  const double slack = reach + 1e-13 * scale;
  return outward(middle - slack, middle + slack);
}
template <class Outline>
HWY_INLINE Along polygon(const Vec3<Along>& p, const Outline& corners) {
  return at_most(polygon(Vec3<Interval>{p.x.v, p.y.v, p.z.v}, corners), length(p.x.d, p.y.d).hi);
}
template <class Outline>
HWY_INLINE Slope polygon(const Vec3<Slope>& p, const Outline& corners) {
  const Vec3<Slope> flat{p.x, p.y, constant<Slope>(0.0)};
  Slope d = distance_at(flat, polygon(Vec3<Interval>{p.x.v, p.y.v, p.z.v}, corners));
  double scale = 1;  // magnitude of the corners, which the error bound in distance_at() does not include
  for (std::size_t i = 0; i < corners.count(); ++i) {
    scale = std::max(scale, std::fabs(corners(i, 0)) + std::fabs(corners(i, 1)));
  }
  const double outline_error = kFloatError / kUnit * scale;
  d.below += outline_error, d.above += outline_error;
  return d;
}

// Computes (re + i im)^n by repeated squaring.
template <class T>
HWY_INLINE void complex_power(T& re, T& im, std::uint32_t n) {
  T base_re = re, base_im = im;
  bool first = true;
  for (;;) {
    if (n & 1) {
      if (first) {
        re = base_re, im = base_im, first = false;
      } else {
        const T x = re * base_re - im * base_im;
        im = re * base_im + im * base_re;
        re = x;
      }
    }
    n >>= 1;
    if (n == 0) return;
    const T x = sqr(base_re) - sqr(base_im);
    base_im = (base_re + base_re) * base_im;
    base_re = x;
  }
}

template <class T>
HWY_INLINE T integer_power(T base, std::uint32_t n) {
  T result = base;
  for (std::uint32_t i = 1; i < n; ++i) result = result * base;
  return result;
}

// Clamps a quotient that is a sine or cosine in exact arithmetic, so that intervals do not blow up at the axis.
template <class T>
HWY_INLINE T clamp_unit(const T& x) {
  return max(constant<T>(-1.0), min(constant<T>(1.0), x));
}

// Daniel White and Paul Nylander's fractal of 2009 about the y axis: w -> w^n + p in spherical coordinates, computed
// without trigonometry by (cos a + i sin a)^n = cos na + i sin na. Distance estimate 1/2 log|w| |w| / |dw| after
// Hart, Sandin & Kauffman, "Ray Tracing Deterministic 3-D Fractals", 1989. The estimate is not a bound: neither
// certified nor Lipschitz. Far out the estimate grows like |p| log|p| and is too large, so there the distance from
// the ball of radius `bound`, which contains the set, limits the result. m and |dw| are kept away from 0 and
// infinity, so nothing is NaN.
template <class T>
HWY_INLINE T mandelbulb(const Vec3<T>& p, std::uint32_t power, std::uint32_t iterations, Constant<T> bailout,
                        Constant<T> bound) {
  const Constant<T> zero = constant<T>(0.0), one = constant<T>(1.0), tiny = constant<T>(1e-30);
  const Constant<T> bailout2 = bailout * bailout, n = constant<T>(power), huge = constant<T>(1e30);
  Vec3<T> w = p;
  T m = sqr(w.x) + sqr(w.y) + sqr(w.z);
  const T distance = sqrt(m);
  T dw = p.x * zero + one;
  for (std::uint32_t i = 0; i < iterations; ++i) {
    const auto active = m < bailout2;
    if (!any(active)) break;
    const T grown = min(huge, integer_power(sqrt(m), power - 1) * dw * n + one);
    const T rho = length(w.x, w.z);
    T re = w.y, im = rho;
    complex_power(re, im, power);
    const T safe_rho = max(tiny, rho);
    const auto on_axis = rho < tiny;
    T cos_a = select(on_axis, p.x * zero + one, clamp_unit(w.z / safe_rho));
    T sin_a = select(on_axis, p.x * zero, clamp_unit(w.x / safe_rho));
    complex_power(cos_a, sin_a, power);
    w.x = select(active, p.x + im * sin_a, w.x);
    w.y = select(active, p.y + re, w.y);
    w.z = select(active, p.z + im * cos_a, w.z);
    dw = select(active, grown, dw);
    m = sqr(w.x) + sqr(w.y) + sqr(w.z);
  }
  m = max(tiny, m);
  const T estimate = log(m) * sqrt(m) / dw * constant<T>(0.25);
  return select(distance > bound + bound, min(estimate, distance - bound), estimate);
}

// Polynomial blend of width k: where |a - b| < k, the result is below the lesser operand by (k - |a-b|)^2 / (4k), at
// most k/4 (Inigo Quilez, "Smooth minimum"). The gradient is a convex combination of a's and b's, so the blend of
// 1-Lipschitz functions is 1-Lipschitz.
template <class T>
HWY_INLINE T smooth_min(const T& a, const T& b, Constant<T> k, Constant<T> inv4k) {
  const T h = max(constant<T>(0.0), k - abs(a - b));
  return min(a, b) - h * h * inv4k;
}
template <class T>
HWY_INLINE T smooth_max(const T& a, const T& b, Constant<T> k, Constant<T> inv4k) {
  // b - a, not a - b: at a tie max() returns b, and abs() has the derivative of its operand. So the gradient at the
  // tie is the mean of a's and b's, and not 1.5 times b's minus half of a's.
  const T h = max(constant<T>(0.0), k - abs(b - a));
  return max(a, b) + h * h * inv4k;
}

template <class T>
HWY_INLINE Convex<T> smooth_min(const Convex<T>& a, const Convex<T>& b, Constant<T> k, Constant<T> inv4k) {
  return blend(smooth_min(a.v, b.v, k, inv4k), a, b, k, min(a, b));
}
template <class T>
HWY_INLINE Convex<T> smooth_max(const Convex<T>& a, const Convex<T>& b, Constant<T> k, Constant<T> inv4k) {
  return blend(smooth_max(a.v, b.v, k, inv4k), a, b, k, max(a, b));
}
template <class T>
HWY_INLINE Tagged<T> smooth_min(const Tagged<T>& a, const Tagged<T>& b, Constant<T> k, Constant<T> inv4k) {
  return {smooth_min(a.v, b.v, k, inv4k), min(a, b).surface};
}
template <class T>
HWY_INLINE Tagged<T> smooth_max(const Tagged<T>& a, const Tagged<T>& b, Constant<T> k, Constant<T> inv4k) {
  return {smooth_max(a.v, b.v, k, inv4k), max(a, b).surface};
}

// Union with a chamfer, a plane at 45 degrees within `radius` of the surfaces' common edge. The plane's term is
// halved, so that the gradients of two parallel surfaces add up to at most 1 (MERCURY's hg_sdf divides by sqrt 2,
// which is exact for orthogonal surfaces and too much for others).
template <class T>
HWY_INLINE T chamfer_min(const T& a, const T& b, Constant<T> radius) {
  const T lesser = min(a, b);  // left operand of the sum, so that the chamfer belongs to the nearer surface
  return min(lesser, (lesser + max(a, b) - radius) * constant<T>(0.5));
}

// Union rounded by a quarter circle that touches both surfaces. The gradient's length reaches sqrt 2 where the
// surfaces are parallel.
template <class T>
HWY_INLINE T round_min(const T& a, const T& b, Constant<T> radius) {
  const Constant<T> zero = constant<T>(0.0);
  return max(radius, min(a, b)) - length(max(zero, radius - a), max(zero, radius - b));
}

// Union with stairs of two faces and height `step` each within `radius` of the common edge (after MERCURY's hg_sdf,
// stairs). The stairs are a fold of a - b, so the Lipschitz constant is at most that of a and b.
template <class T>
HWY_INLINE T stairs_min(const T& a, const T& b, const Constant<T>* k) {  // k: radius, step, 1 / (2 step)
  const T lesser = min(a, b), greater = max(a, b);
  const T rise = greater - k[0] - lesser + k[1];
  const T fold = abs(rise - floor(rise * k[2]) * (k[1] + k[1]) - k[1]);
  return min(lesser, (lesser + greater - k[0] + fold) * constant<T>(0.5));
}

// Intersection of two solids whose distances are measured in orthogonal directions: an outline and a slab, a profile
// and a disc. Exact where both are.
template <class T>
HWY_INLINE T meet(const T& a, const T& b) {
  const Constant<T> zero = constant<T>(0.0);
  return length(max(zero, a), max(zero, b)) + min(zero, max(a, b));
}
// One of the two summands is 0, so their gradients do not add up.
HWY_INLINE Slope meet(const Slope& a, const Slope& b) {
  const Slope zero = constant<Slope>(0.0), outer = length(max(zero, a), max(zero, b)), inner = max(a, b);
  const Slope sum = outer + min(zero, inner);
  return either(outer, inner, sum.v, sum.below, sum.above);
}

// Smooth minimum and maximum are nondecreasing in both operands, so the operands' ends give the ranges. The generic
// formula uses a and b several times and would widen the result by up to k.
HWY_INLINE Interval smooth_min(Interval a, Interval b, Interval k, Interval inv4k) {
  const auto end = [&](double x, double y) HWY_ATTR {
    const Interval h = max(Interval{0, 0}, k - abs(Interval{x, x} - Interval{y, y}));
    return Interval{std::min(x, y), std::min(x, y)} - h * h * inv4k;
  };
  if (!(std::isfinite(a.lo) && std::isfinite(a.hi) && std::isfinite(b.lo) && std::isfinite(b.hi)))
    return whole_line();
  return {end(a.lo, b.lo).lo, end(a.hi, b.hi).hi};
}
HWY_INLINE Interval smooth_max(Interval a, Interval b, Interval k, Interval inv4k) {
  return -smooth_min(-a, -b, k, inv4k);
}

HWY_INLINE Along smooth_min(const Along& a, const Along& b, const Along& k, const Along& inv4k) {
  return either(a, b, smooth_min(a.v, b.v, k.v, inv4k.v));  // because the derivative is between a's and b's
}
HWY_INLINE Along smooth_max(const Along& a, const Along& b, const Along& k, const Along& inv4k) {
  return -smooth_min(-a, -b, k, inv4k);
}
HWY_INLINE Slope smooth_min(const Slope& a, const Slope& b, const Slope& k, const Slope& inv4k) {
  const Slope generic = smooth_min<Slope>(a, b, k, inv4k);
  // The gradient is between a's and b's, and a blend of nonnegative operands can be negative.
  Slope r = either(a, b, smooth_min(a.v, b.v, k.v, inv4k.v), generic.error(), generic.error());
  r.nonnegative = false;
  return r;
}
HWY_INLINE Slope smooth_max(const Slope& a, const Slope& b, const Slope& k, const Slope& inv4k) {
  return -smooth_min(-a, -b, k, inv4k);
}

}  // namespace fathom::vm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
