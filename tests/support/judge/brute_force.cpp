#include "tests/support/judge/brute_force.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <limits>
#include <numbers>

#include "tests/support/judge/judge_geometry.h"
#include "vm/program/check.h"

namespace fathom::test {
namespace {

using compiler::Kind;
using glm::dvec2;
using glm::dvec3;

// Grid nodes per side: two minima on one patch are always at least two cells apart.
constexpr int kGrid = 16;
// Relative to the patch's side: smaller steps change less than 1e-10 of the distance.
constexpr double kSmallestStep = 1e-12;

// Minimises |map(u,v) - p| near (u, v): tries the eight neighbours at the current step and halves the step when none
// of them is nearer.
template <typename Map>
double polish(const Map& map, dvec3 p, double u, double v) {
  const auto distance2 = [&](double s, double t) {
    const dvec3 d = map(s, t) - p;
    return glm::dot(d, d);
  };
  double best = distance2(u, v);
  for (double step = 1.0 / kGrid; step > kSmallestStep;) {
    double next_u = u, next_v = v;
    for (int i = 0; i < 9; ++i) {
      const double s = std::clamp(u + step * (i % 3 - 1), 0.0, 1.0), t = std::clamp(v + step * (i / 3 - 1), 0.0, 1.0);
      const double d = distance2(s, t);
      if (d < best) best = d, next_u = s, next_v = t;
    }
    if (next_u == u && next_v == v) step /= 2;
    u = next_u, v = next_v;
  }
  return std::sqrt(best);
}

// Arc of a circle between two polar angles (from +y), as a profile in (rho, y).
std::function<dvec2(double)> arc(double rho, double y, double radius, double from, double to) {
  return [=](double t) {
    const double angle = from + t * (to - from);
    return dvec2(rho + radius * std::sin(angle), y + radius * std::cos(angle));
  };
}
std::function<dvec2(double)> segment(dvec2 a, dvec2 b) {
  return [=](double t) { return (1 - t) * a + t * b; };
}


}  // namespace

BruteForce::BruteForce(Kind kind, std::span<const double> k) {
  switch (kind) {
    case Kind::Box:
      build_box(vec3_at(k, 0), 0);
      break;
    case Kind::RoundBox:
      build_box(vec3_at(k, 0), k[3]);
      break;
    case Kind::Plane:
      build_plane(vec3_at(k, 0), k[3]);
      break;
    case Kind::RoundCone:
      build_round_cone(k[0], k[1], k[2]);
      break;
    case Kind::Triangle:
      build_sheet(k.first(9), k[9]);
      break;
    case Kind::Quad:
      build_sheet(k.first(12), k[12]);
      break;
    default:
      if (!build_solid(kind, k)) build_revolved(kind, k);
  }
}

void BruteForce::add(Map map) {
  Patch patch{std::move(map), {}, 0};
  for (int i = 0; i <= kGrid; ++i) {
    for (int j = 0; j <= kGrid; ++j) patch.nodes.push_back(patch.map(double(i) / kGrid, double(j) / kGrid));
  }
  for (std::size_t i = 0; i + kGrid + 2 < patch.nodes.size(); ++i) {
    patch.cell = std::max(patch.cell, glm::length(patch.nodes[i + kGrid + 2] - patch.nodes[i]));
  }
  patches_.push_back(std::move(patch));
}

double BruteForce::distance(dvec3 p) const {
  double best = std::numeric_limits<double>::infinity();
  for (const Patch& patch : patches_) best = distance_to(patch, p, best);
  return (inside_(p) ? -best : best) - thickness_;
}

// Polishes every grid node that is no farther than its neighbours and whose cells could still improve on `best`.
// Equal neighbours (the poles of a parametrisation) are all polished, because each can only reach its own side.
double BruteForce::distance_to(const Patch& patch, dvec3 p, double best) {
  double d[kGrid + 1][kGrid + 1];
  for (int i = 0; i <= kGrid; ++i) {
    for (int j = 0; j <= kGrid; ++j) {
      d[i][j] = glm::length(patch.nodes[static_cast<std::size_t>(i * (kGrid + 1) + j)] - p);
    }
  }
  for (int i = 0; i <= kGrid; ++i) {
    for (int j = 0; j <= kGrid; ++j) {
      bool least = d[i][j] < best + 2 * patch.cell;
      for (int n = 0; n < 9 && least; ++n) {
        const int a = std::clamp(i + n % 3 - 1, 0, kGrid), b = std::clamp(j + n / 3 - 1, 0, kGrid);
        least = d[i][j] <= d[a][b] + 1e-9 * patch.cell;
      }
      if (least) best = std::min(best, polish(patch.map, p, double(i) / kGrid, double(j) / kGrid));
    }
  }
  return best;
}

void BruteForce::revolve(std::function<dvec2(double t)> profile) {
  add([profile = std::move(profile)](double u, double v) {
    const dvec2 q = profile(u);
    return dvec3(q.x * std::sin(2 * kPi * v), q.y, q.x * std::cos(2 * kPi * v));
  });
}

// Six faces; a rounded box also has twelve quarter cylinders and eight octants. There is one piece per sign of each
// axis, where 0 means "along the inner box". A piece is the inner box's face, edge or corner plus the rounding along
// its normals.
void BruteForce::build_box(dvec3 half, double rounding) {
  const dvec3 inner = half - rounding;
  for (int piece = 0; piece < 27; ++piece) {
    const int sign[3] = {piece % 3 - 1, piece / 3 % 3 - 1, piece / 9 - 1};
    const int fixed = std::abs(sign[0]) + std::abs(sign[1]) + std::abs(sign[2]);
    if (fixed == 0 || (fixed > 1 && rounding == 0)) continue;
    add([=](double u, double v) {
      const double a = u * kPi / 2, b = v * kPi / 2;  // angles of the normals that fan out between the fixed axes
      const double fan[4][3] = {{},
                                {1, 0, 0},
                                {std::cos(a), std::sin(a), 0},
                                {std::cos(a) * std::cos(b), std::sin(a) * std::cos(b), std::sin(b)}};
      const double along[2] = {fixed == 2 ? v : u, v};
      dvec3 point(0);
      for (int axis = 0, f = 0, free = 0; axis < 3; ++axis) {
        if (sign[axis] == 0) {
          point[axis] = inner[axis] * (2 * along[free++] - 1);
        } else {
          point[axis] = sign[axis] * (inner[axis] + rounding * fan[fixed][f++]);
        }
      }
      return point;
    });
  }
  // Inside when the overshoot over the inner box, as a vector over the axes, is shorter than the rounding.
  inside_ = [=](dvec3 p) {
    double overshoot2 = 0;
    for (int axis = 0; axis < 3; ++axis) {
      if (std::abs(p[axis]) >= half[axis]) return false;
      const double over = std::max(std::abs(p[axis]) - inner[axis], 0.0);
      overshoot2 += over * over;
    }
    return rounding == 0 || overshoot2 < rounding * rounding;
  };
}

void BruteForce::build_revolved(Kind kind, std::span<const double> k) {
  if (kind == Kind::Sphere) {
    revolve(arc(0, 0, k[0], 0, kPi));
    inside_ = [r = k[0]](dvec3 p) { return glm::dot(p, p) < r * r; };
  } else if (kind == Kind::Torus) {
    // Inside test by the torus quartic (|p|^2 + R^2 - r^2)^2 = 4 R^2 rho^2, with the root chosen so that a spindle's
    // lens counts as inside. A spindle's boundary is the part of the circle that stays on its side of the axis:
    // sin(angle) >= -R/r.
    const double beyond = k[1] > k[0] ? std::asin(k[0] / k[1]) : kPi / 2;
    revolve(arc(k[0], 0, k[1], -beyond, kPi + beyond));
    inside_ = [R = k[0], r = k[1]](dvec3 p) {
      return glm::dot(p, p) + R * R - r * r < 2 * R * std::sqrt(p.x * p.x + p.z * p.z);
    };
  } else if (kind == Kind::Cylinder || kind == Kind::Cone) {
    const double h = kind == Kind::Cone ? k[2] : k[1], bottom = k[0], top = kind == Kind::Cone ? k[1] : k[0];
    revolve(segment({0, -h}, {bottom, -h}));
    revolve(segment({bottom, -h}, {top, h}));
    revolve(segment({top, h}, {0, h}));
    inside_ = [=](dvec3 p) {  // the cross section at height y is a disc of area pi radius^2
      const double radius = bottom * (h - p.y) / (2 * h) + top * (h + p.y) / (2 * h);
      return p.y > -h && p.y < h && p.x * p.x + p.z * p.z < radius * radius;
    };
  } else {
    CHECK(kind == Kind::RoundedCylinder, "a solid of revolution");
    const double radius = k[0], h = k[1], e = k[2];
    revolve(segment({0, -h}, {radius - e, -h}));
    revolve(segment({radius, -h + e}, {radius, h - e}));
    revolve(segment({radius - e, h}, {0, h}));
    revolve(arc(radius - e, h - e, e, 0, kPi / 2));
    revolve(arc(radius - e, -h + e, e, kPi / 2, kPi));
    inside_ = [=](dvec3 p) {  // the cross section at height y is a disc, smaller near the caps
      const double into_cap = std::abs(p.y) - (h - e);
      if (into_cap >= e) return false;
      const double at = into_cap > 0 ? radius - e + std::sqrt(e * e - into_cap * into_cap) : radius;
      return p.x * p.x + p.z * p.z < at * at;
    };
  }
}

// Two spherical caps and the cone that touches both balls, where the normal's slope is s = (bottom - top) / height
// (similar triangles). One ball alone when it contains the other.
void BruteForce::build_round_cone(double bottom, double top, double height) {
  const double s = (bottom - top) / height;
  if (s >= 1) {
    revolve(arc(0, 0, bottom, 0, kPi));
  } else if (s <= -1) {
    revolve(arc(0, height, top, 0, kPi));
  } else {
    const double touch = std::acos(s);  // polar angle of the cone's normals
    revolve(arc(0, 0, bottom, touch, kPi));
    revolve(arc(0, height, top, 0, touch));
    revolve(segment(arc(0, 0, bottom, touch, touch)(0), arc(0, height, top, touch, touch)(0)));
  }
  // Inside when one ball of the family contains p. The balls' radii vary linearly with their height. A ternary search
  // finds the ball with the smallest clearance.
  inside_ = [=](dvec3 p) {
    const auto clearance = [&](double t) {
      return glm::length(p - dvec3(0, t * height, 0)) - (bottom + t * (top - bottom));
    };
    double lo = 0, hi = 1;
    for (int i = 0; i < 100; ++i) {
      const double a = lo + (hi - lo) / 3, b = hi - (hi - lo) / 3;
      (clearance(a) < clearance(b) ? hi : lo) = clearance(a) < clearance(b) ? b : a;
    }
    return clearance((lo + hi) / 2) < 0;
  };
}

// Square of the plane, large enough for points within 64 of the origin.
void BruteForce::build_plane(dvec3 normal, double offset) {
  const dvec3 n = normal / std::sqrt(glm::dot(normal, normal));
  const dvec3 e = glm::normalize(glm::cross(n, std::abs(n.x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 1, 0)));
  const dvec3 f = glm::cross(n, e);
  add([=](double u, double v) { return n * offset + 128.0 * ((u - 0.5) * e + (v - 0.5) * f); });
  inside_ = [=](dvec3 p) { return glm::dot(p - n * offset, n) < 0; };
}

// Triangle (a degenerate bilinear patch) or quadrilateral, with unsigned distance.
void BruteForce::build_sheet(std::span<const double> corners, double thickness) {
  const dvec3 a = vec3_at(corners, 0), b = vec3_at(corners, 3), c = vec3_at(corners, 6);
  const dvec3 d = corners.size() == 12 ? vec3_at(corners, 9) : c;
  add([=](double u, double v) { return (1 - v) * ((1 - u) * a + u * b) + v * ((1 - u) * d + u * c); });
  inside_ = [](dvec3) { return false; };
  thickness_ = thickness;
}

}  // namespace fathom::test
