#include "bench/hand_written.h"

#include <algorithm>
#include <utility>

#ifndef HWY_DISABLED_TARGETS
#define HWY_DISABLED_TARGETS HWY_SSSE3
#endif
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bench/hand_written.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "vm/number/batch-inl.h"

HWY_BEFORE_NAMESPACE();
namespace fathom::bench::HWY_NAMESPACE {

using namespace fathom::vm::HWY_NAMESPACE;
using B = Batch;
HWY_INLINE B c(double value) { return Batch::broadcast(value); }
HWY_INLINE B zero() { return c(0); }
HWY_INLINE B clamp(B x, double lo, double hi) { return max(c(lo), min(c(hi), x)); }

struct P {
  B x, y, z;
};
HWY_INLINE P at(P p, double x, double y, double z) { return {p.x - c(x), p.y - c(y), p.z - c(z)}; }

HWY_INLINE B sphere(P p, double r) { return length(p.x, p.y, p.z) - c(r); }
HWY_INLINE B box(P p, double x, double y, double z) {
  const B qx = abs(p.x) - c(x), qy = abs(p.y) - c(y), qz = abs(p.z) - c(z);
  return length(max(qx, zero()), max(qy, zero()), max(qz, zero())) + min(max(qx, max(qy, qz)), zero());
}
HWY_INLINE B torus(P p, double major, double minor) { return length(length(p.x, p.z) - c(major), p.y) - c(minor); }
HWY_INLINE B cylinder(P p, double r, double h) {
  const B dx = length(p.x, p.z) - c(r), dy = abs(p.y) - c(h);
  return length(max(dx, zero()), max(dy, zero())) + min(max(dx, dy), zero());
}
// Quilez' capped cone and round cone.
HWY_INLINE B cone(P p, double h, double r1, double r2) {
  const B qx = length(p.x, p.z), qy = p.y;
  const double kx = r2 - r1, ky = 2 * h, inverse = 1 / (kx * kx + ky * ky);
  const B ax = qx - min(qx, select(qy < zero(), c(r1), c(r2))), ay = abs(qy) - c(h);
  const B t = clamp(((c(r2) - qx) * c(kx) + (c(h) - qy) * c(ky)) * c(inverse), 0, 1);
  const B bx = qx - c(r2) + c(kx) * t, by = qy - c(h) + c(ky) * t;
  const B d = sqrt(min(ax * ax + ay * ay, bx * bx + by * by));
  return select(max(bx, ay) < zero(), -d, d);
}
HWY_INLINE B round_cone(P p, double r1, double r2, double h) {
  const double b = (r1 - r2) / h, a = 0.9270248108869578;  // sqrt(1 - b^2) for the one cone there is
  const B qx = length(p.x, p.z), qy = p.y;
  const B k = qy * c(a) - qx * c(b);
  const B side = qx * c(a) + qy * c(b) - c(r1);
  return select(k < zero(), length(qx, qy) - c(r1), select(c(a * h) < k, length(qx, qy - c(h)) - c(r2), side));
}

struct V {
  double x, y, z;
};
constexpr V operator-(V a, V b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
constexpr V cross(V a, V b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
constexpr double dot(V a, V b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
HWY_INLINE B dot(V a, P p) { return c(a.x) * p.x + c(a.y) * p.y + c(a.z) * p.z; }

// Quilez' udTriangle and udQuad: squared distance to the edges, or to the plane where all edges' planes agree.
template <std::size_t N>
HWY_INLINE B polygon(P p, const V (&v)[N], double thickness) {
  const V normal = cross(v[1] - v[0], v[0] - v[N - 1]);
  B nearest = c(1e30), inward = c(1e30);
  for (std::size_t i = 0; i < N; ++i) {
    const V e = v[(i + 1) % N] - v[i];
    const P w = at(p, v[i].x, v[i].y, v[i].z);
    const B t = clamp(dot(e, w) * c(1 / dot(e, e)), 0, 1);
    const B x = c(e.x) * t - w.x, y = c(e.y) * t - w.y, z = c(e.z) * t - w.z;
    nearest = min(nearest, x * x + y * y + z * z);
    inward = min(inward, dot(cross(e, normal), w));
  }
  const B height = dot(normal, at(p, v[0].x, v[0].y, v[0].z));
  return sqrt(select(inward < zero(), nearest, height * height * c(1 / dot(normal, normal)))) - c(thickness);
}

HWY_INLINE B primitives(P p) {
  B d = p.y;
  d = min(d, sphere(at(p, -4.8, 1, -1.2), 0.9));
  d = min(d, box(at(p, -2.4, 1, -1.2), 0.7, 0.8, 0.6));
  d = min(d, box(at(p, 0, 1, -1.2), 0.6, 0.7, 0.5) - c(0.15));
  d = min(d, torus(at(p, 2.4, 1, -1.2), 0.65, 0.25));
  d = min(d, cylinder(at(p, 4.8, 1, -1.2), 0.55, 0.8));
  d = min(d, cylinder(at(p, -4.8, 1, 1.2), 0.55, 0.7) - c(0.15));
  d = min(d, cone(at(p, -2.4, 1, 1.2), 0.8, 0.7, 0.3));
  d = min(d, round_cone(at(p, 0, 0.6, 1.2), 0.55, 0.25, 0.8));
  d = min(d, polygon(at(p, 2.4, 1, 1.2), {{-0.8, -0.7, 0.3}, {0.8, -0.6, -0.2}, {0, 0.8, 0.1}}, 0.03));
  return min(d, polygon(at(p, 4.8, 1, 1.2),
                        {{-0.8, -0.7, 0.3}, {0.7, -0.7, -0.3}, {0.8, 0.7, -0.1}, {-0.7, 0.7, 0.5}}, 0.03));
}

HWY_INLINE B smin(B a, B b) {
  const B h = max(c(0.2) - abs(a - b), zero());
  return min(a, b) - h * h * c(0.25 / 0.2);
}

// Row i of the published table: centre, then a sphere's radius, a box's half extents or a torus' two radii.
struct Row {
  double x, y, z, a, b, c;
};
constexpr Row kRows[30] = {
    {-0.8, 1.3016, 0.568, 0.5727, 0, 0},
    {0.572, 1.5272, 1.6, 0.2906, 0.4754, 0.56955},
    {0.368, 1.7976, -0.176, 0.5589, 0.22446, 0},
    {0.604, 1.468, -1.376, 0.26645, 0, 0},
    {1.372, 1.636, 1.872, 0.44705, 0.355, 0.4936},
    {-1.388, 1.3, -0.936, 0.5904, 0.11134, 0},
    {-0.136, 0.4936, 1.508, 0.5146, 0, 0},
    {1.2, 0.364, -1.244, 0.3606, 0.2885, 0.32525},
    {-0.752, 1.7176, -1.092, 0.50815, 0.17896, 0},
    {1.664, 1.1512, -0.536, 0.2521, 0, 0},
    {-1.9, 1.4328, 1.644, 0.4971, 0.39035, 0.52685},
    {-1.804, 1.3112, 1.656, 0.55995, 0.11988, 0},
    {0.02, 1.7352, 1.084, 0.2612, 0, 0},
    {-0.068, 1.1464, -1.72, 0.5986, 0.25385, 0.3732},
    {0.996, 1.6568, 1.348, 0.64395, 0.11232, 0},
    {-1.94, 0.4296, -1.308, 0.572, 0, 0},
    {1.584, 1.2296, 0.272, 0.53385, 0.43025, 0.4607},
    {-1.328, 1.0264, 0.64, 0.70625, 0.17266, 0},
    {0.84, 1.2024, 1.62, 0.3683, 0, 0},
    {-0.232, 0.7144, 1.892, 0.2612, 0.48765, 0.5629},
    {1.628, 1.4296, -0.324, 0.6436, 0.2358, 0},
    {1.016, 0.716, -1.624, 0.54505, 0, 0},
    {1.12, 0.5464, -1.16, 0.51145, 0.5909, 0.50935},
    {-0.072, 1.8712, 0.44, 0.6716, 0.19842, 0},
    {-0.768, 1.6184, 1.336, 0.3669, 0, 0},
    {-1.648, 0.7032, -0.088, 0.313, 0.4117, 0.38125},
    {-1.236, 0.492, -0.18, 0.44655, 0.12758, 0},
    {-1.168, 1.148, -0.48, 0.3823, 0, 0},
    {-1.868, 1.5912, 1.736, 0.54015, 0.59125, 0.5622},
    {1.632, 0.9592, 1.496, 0.6541, 0.1518, 0},
};

template <std::size_t I>
HWY_INLINE B part(P p) {
  constexpr Row r = kRows[I];
  const P q = at(p, r.x, r.y, r.z);
  if constexpr (I % 3 == 0) return sphere(q, r.a);
  if constexpr (I % 3 == 1) return box(q, r.a, r.b, r.c);
  return torus(q, r.a, r.b);
}
template <std::size_t I>
HWY_INLINE void blend(B& d, P p) {
  d = I % 5 == 4 ? -smin(-d, part<I>(p)) : smin(d, part<I>(p));
}
template <std::size_t... I>
HWY_INLINE B carve(P p, std::index_sequence<0, I...>) {
  B d = part<0>(p);
  (blend<I>(d, p), ...);
  return min(d, p.y);
}

template <class F>
HWY_INLINE void for_each(vm::Points points, std::size_t count, float* distance, const F& f) {
  for (std::size_t i = 0; i + kLanes <= count; i += kLanes) {
    f(P{B::load(points.x + i), B::load(points.y + i), B::load(points.z + i)}).store(distance + i);
  }
}

void primitives_field(vm::Points points, std::size_t count, float* distance) {
  for_each(points, count, distance, [](P p) HWY_ATTR { return primitives(p); });
}
void csg_field(vm::Points points, std::size_t count, float* distance) {
  for_each(points, count, distance, [](P p) HWY_ATTR { return carve(p, std::make_index_sequence<30>()); });
}

}  // namespace fathom::bench::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace fathom::bench {

HWY_EXPORT(primitives_field);
HWY_EXPORT(csg_field);

void primitives_by_hand(vm::Points points, std::size_t count, float* distance) {
  HWY_DYNAMIC_DISPATCH(primitives_field)(points, count, distance);
}
void csg_by_hand(vm::Points points, std::size_t count, float* distance) {
  HWY_DYNAMIC_DISPATCH(csg_field)(points, count, distance);
}

}  // namespace fathom::bench
#endif
