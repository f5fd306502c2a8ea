// Definitions of the opcodes that fold, repeat or bend space, over any number type of vm/number/. A map that is
// evaluated only near its solid has a limit opcode too: a distance to the part that is left out, which bounds the
// result from above (compiler/shapes/domain.cpp derives the constants).
// Tested by: tests/compiler/shapes/domain_test.cpp
#if defined(FATHOM_VM_DOMAIN_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef FATHOM_VM_DOMAIN_INL
#undef FATHOM_VM_DOMAIN_INL
#else
#define FATHOM_VM_DOMAIN_INL
#endif

#include "vm/number/along-inl.h"
#include "vm/number/interval_elementary-inl.h"
#include "vm/number/number-inl.h"

HWY_BEFORE_NAMESPACE();
namespace fathom::vm::HWY_NAMESPACE {

// Removes the middle: coordinates within [-by, by] become 0, all others move towards 0 by `by`.
template <class T>
HWY_INLINE T pull(const T& a, Constant<T> by) {
  return a - max(-by, min(by, a));
}
// pull() is nondecreasing in `a`, so a's ends give the range. The difference in interval arithmetic would be as wide
// as `a` even where pull() is 0.
HWY_INLINE Along pull(const Along& a, const Along& by) {
  const auto at = [&](double end) { return pull(Interval{end, end}, by.v); };
  return {{at(a.v.lo).lo, at(a.v.hi).hi}, pull<Along>(a, by).d};
}
template <class T>
HWY_INLINE Vec3<T> elongate(const Vec3<T>& p, Constant<T> x, Constant<T> y, Constant<T> z) {
  return {pull(p.x, x), pull(p.y, y), pull(p.z, z)};
}

// Mirrors points behind the plane to its front. k: unit normal, offset.
template <class T>
HWY_INLINE Vec3<T> mirror(const Vec3<T>& p, const Constant<T>* k) {
  const T behind = min(constant<T>(0.0), p.x * k[0] + p.y * k[1] + p.z * k[2] - k[3]);
  const T twice = behind + behind;
  return {p.x - twice * k[0], p.y - twice * k[1], p.z - twice * k[2]};
}

// Maps p to the outline's plane: x is the distance from the y axis minus `offset`, y stays.
template <class T>
HWY_INLINE Vec3<T> revolve(const Vec3<T>& p, Constant<T> offset) {
  return {length(p.x, p.z) - offset, p.y, p.z};
}

// Returns the number of a's cell along one axis. k: cells per unit, shift, first and last number.
template <class T>
HWY_INLINE T cell_number(const T& a, const Constant<T>* k) {
  return max(k[2], min(k[3], floor(a * k[0] + k[1])));
}
// Returns `a` relative to the copy of cell `number`. k: as cell_number, then offset and period; the copy of cell j is
// at (j + offset) * period. All copies evaluated at a point use the same cell number and differ in the offset. With
// cell numbers of their own, a copy could be skipped where rounding moves a cell's boundary.
template <class T>
HWY_INLINE T in_cell(const T& a, const T& number, const Constant<T>* k) {
  return a - (number + k[4]) * k[5];
}
template <class T>
HWY_INLINE Vec3<T> cell(const Vec3<T>& p, const Constant<T>* k) {
  return {in_cell(p.x, cell_number(p.x, k), k), in_cell(p.y, cell_number(p.y, k + 6), k + 6),
          in_cell(p.z, cell_number(p.z, k + 12), k + 12)};
}

// Maps an integer to an integer in 0..288: (34 n + 1) n mod 289, a permutation, exact in float (Stefan Gustavson and
// Ian McEwan, "Psrdnoise", JCGT 2022, section 2.1, use this function for the same reason).
template <class T>
HWY_INLINE T permute(const T& n) {
  const T m = n - floor(n * constant<T>(1.0 / 289) + constant<T>(0.5 / 289)) * constant<T>(289.0);
  const T mixed = (m * constant<T>(34.0) + constant<T>(1.0)) * m;
  return mixed - floor(mixed * constant<T>(1.0 / 289) + constant<T>(0.5 / 289)) * constant<T>(289.0);
}
// A range that contains more than one integer gives the full range 0..288.
HWY_INLINE Interval permute(Interval n) {
  const double nearest = std::floor(n.lo + 0.5);
  if (!(n.hi - n.lo < 0.5 && n.lo >= nearest - 0.25 && n.hi <= nearest + 0.25)) return {0, 288};
  const double m = nearest - 289 * std::floor(nearest / 289), mixed = (34 * m + 1) * m;
  const double result = mixed - 289 * std::floor(mixed / 289);
  return {result, result};
}

HWY_INLINE Along permute(const Along& n) { return steps(n, permute(n.v)); }

// Like cell(), with copy (i, j, l) moved by up to k[18], k[19], k[20] along the axes, by a pseudorandom amount per
// copy. k[21..23]: offset of the copy's numbers from the cell's.
template <class T>
HWY_INLINE Vec3<T> cell_jitter(const Vec3<T>& p, const Constant<T>* k) {
  const Constant<T> inverse = constant<T>(1.0 / 144), one = constant<T>(1.0);
  const T i = cell_number(p.x, k), j = cell_number(p.y, k + 6), l = cell_number(p.z, k + 12);
  const T x = permute(permute(permute(i + k[21]) + j + k[22]) + l + k[23]), y = permute(x + one),
          z = permute(y + one);
  return {in_cell(p.x, i, k) - (x * inverse - one) * k[18], in_cell(p.y, j, k + 6) - (y * inverse - one) * k[19],
          in_cell(p.z, l, k + 12) - (z * inverse - one) * k[20]};
}

// Returns the distance of `a` from [lo, hi], 0 inside.
template <class T>
HWY_INLINE T beyond(const T& a, Constant<T> lo, Constant<T> hi) {
  return max(constant<T>(0.0), max(lo - a, a - hi));
}

// Limit of a repetition: distance to the copies that are not evaluated. k: per axis, the six of in_cell, the distance
// of these copies from the plane through the middle of the nearest evaluated copy, the minimum and the maximum
// coordinate of any copy.
template <class T>
HWY_INLINE T cell_limit(const Vec3<T>& p, const Constant<T>* k) {
  const auto near2 = [k](const T& a, int axis) HWY_ATTR {
    const Constant<T>* of = k + 9 * axis;
    return sqr(abs(in_cell(a, cell_number(a, of), of)) + of[6]);
  };
  const auto out2 = [k](const T& a, int axis) HWY_ATTR { return sqr(beyond(a, k[9 * axis + 7], k[9 * axis + 8])); };
  const T x = out2(p.x, 0), y = out2(p.y, 1), z = out2(p.z, 2);
  return sqrt(min(near2(p.x, 0) + y + z, min(x + near2(p.y, 1) + z, x + y + near2(p.z, 2))));
}

template <class T>
HWY_INLINE Vec3<T> turn_about_y(const Vec3<T>& p, const T& angle) {
  const T c = cos(angle), s = sin(angle);
  return {p.x * c + p.z * s, p.y, p.z * c - p.x * s};
}

// Rotates p's sector onto sector 0. k: sectors per radian, shift, radians per sector, copy. Copy n of sector j is
// sector j + n rotated onto sector 0. Like cells, all copies use the same sector number.
template <class T>
HWY_INLINE Vec3<T> sector(const Vec3<T>& p, const Constant<T>* k) {
  return turn_about_y(p, (floor(atan2(p.z, p.x) * k[0] + k[1]) + k[3]) * k[2]);
}
// Limit of sectors: distance to the copies that are not evaluated. k: first three as in sector(), where the shift
// rounds to the nearest copy's middle at angle k[3]. k[4]: angle between these copies and the half-plane through that
// middle. k[5]: distance of these copies from the axis. k[6], k[7]: minimum and maximum y of a copy. A half-plane at
// an angle a from p has the distance rho sin a, or rho beyond a right angle.
template <class T>
HWY_INLINE T sector_limit(const Vec3<T>& p, const Constant<T>* k) {
  const T angle = atan2(p.z, p.x), rho = length(p.x, p.z);
  const T aside = abs(angle - k[3] - floor(angle * k[0] + k[1]) * k[2]) + k[4];
  const T across = rho * sin(min(constant<T>(1.5707963267948966), aside));
  return length(max(across, k[5] - rho), beyond(p.y, k[6], k[7]));
}

// Moves p onto the cylinder of radius `radius` about the y axis, if p is outside.
template <class T>
HWY_INLINE Vec3<T> clamp_tube(const Vec3<T>& p, Constant<T> radius) {
  const T inside = min(constant<T>(1.0), radius / max(constant<T>(1e-30), length(p.x, p.z)));
  return {p.x * inside, p.y, p.z * inside};
}
// Clamps p to the box from k[0..2] to k[3..5].
template <class T>
HWY_INLINE Vec3<T> clamp_box(const Vec3<T>& p, const Constant<T>* k) {
  return {max(k[0], min(k[3], p.x)), max(k[1], min(k[4], p.y)), max(k[2], min(k[5], p.z))};
}
// Distance from the box from k[0..2] to k[3..5], exact inside and outside.
template <class T>
HWY_INLINE T box_between(const Vec3<T>& p, const Constant<T>* k) {
  const Constant<T> zero = constant<T>(0.0);
  const T x = max(k[0] - p.x, p.x - k[3]), y = max(k[1] - p.y, p.y - k[4]), z = max(k[2] - p.z, p.z - k[5]);
  return length(max(zero, x), max(zero, y), max(zero, z)) + min(zero, max(x, max(y, z)));
}

// Divides x and z by a scale that is linear in y. k: scale at y = 0, its change per unit, minimum and maximum scale.
template <class T>
HWY_INLINE Vec3<T> taper(const Vec3<T>& p, const Constant<T>* k) {
  const T scale = max(k[2], min(k[3], p.y * k[1] + k[0]));
  return {p.x / scale, p.y, p.z / scale};
}

// A circular bend: the x axis becomes a circle around (0, k[0]) and keeps its arc length (Alan Barr, "Global and
// Local Deformations of Solid Primitives", 1984, section 4.4). k: radius > 0; +1 to bend towards +y, -1 towards -y;
// inner radius, the minimum to which distances from the centre are clamped.
template <class T>
HWY_INLINE Vec3<T> bend(const Vec3<T>& p, const Constant<T>* k) {
  const T below = k[0] - p.y * k[1];
  const T rho = max(k[2], length(p.x, below));
  return {atan2(p.x, below) * k[0], (k[0] - rho) * k[1], p.z};
}
// Limit of a bend: distance to the solid along paths that bend() does not follow, through the middle or across the
// seam opposite the origin. k: the three of bend(), the solid's distances from the inner circle and from the seam,
// its minimum and maximum z, and a factor for distances in z.
template <class T>
HWY_INLINE T bend_limit(const Vec3<T>& p, const Constant<T>* k) {
  const Constant<T> zero = constant<T>(0.0);
  const T below = k[0] - p.y * k[1], rho = length(p.x, below);
  const T to_middle = max(zero, rho - k[2]) + k[3];
  const T to_seam = select(below < zero, abs(p.x), rho) + k[4];
  return length(min(to_middle, to_seam), beyond(p.z, k[5], k[6]) * k[7]);
}

}  // namespace fathom::vm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
