// The judge of frames, arcs, unbounded solids, polyhedra and fractals, by explicit bars, corners, faces and cells.
#include <array>
#include <complex>
#include <glm/common.hpp>
#include <glm/vec2.hpp>
#include <numbers>

#include "tests/support/judge/judge_geometry.h"

namespace fathom::test {
namespace {

using compiler::Kind;
using glm::dvec2;
using glm::dvec3;



// Twelve bars: boxes 2 thickness wide. The complement of the frame is the outside of the box and three shafts through
// the box. Inside the frame, the distance is that to the nearest of these four.
double box_frame(dvec3 p, dvec3 half, double thickness) {
  double to_bars = kInfinity, way_out = -distance_to_box(p, half);
  for (int axis = 0; axis < 3; ++axis) {
    dvec3 bar(thickness), shaft = half - 2 * thickness;
    bar[axis] = half[axis];
    shaft[axis] = 1e6;
    way_out = std::min(way_out, distance_to_box(p, shaft));
    for (int i = 0; i < 4; ++i) {
      dvec3 centre = half - thickness;
      centre[axis] = 0;
      if (i % 2) centre[(axis + 1) % 3] *= -1;
      if (i / 2) centre[(axis + 2) % 3] *= -1;
      to_bars = std::min(to_bars, distance_to_box(p - centre, bar));
    }
  }
  return to_bars < 0 ? -way_out : to_bars;
}

// All points within `minor` of an arc. The nearest point of a full circle has p's direction. The nearest point of an
// arc is the nearer end when that direction is not on the arc.
double capped_torus(dvec3 p, double major, double minor, double angle) {
  const double direction = std::atan2(p.x, p.y), reach = radians(angle);
  const double nearest = std::clamp(direction, -reach, reach);
  return glm::length(p - major * dvec3(std::sin(nearest), std::cos(nearest), 0)) - minor;
}

// In the half-plane (rho, y) the side is a ray from the tip.
double infinite_cone(dvec3 p, double angle) {
  const dvec2 q(std::hypot(p.x, p.z), p.y), side(std::sin(radians(angle)), -std::cos(radians(angle)));
  const double t = std::max(0.0, glm::dot(q, side));
  const double to_side = glm::length(q - t * side);
  return std::atan2(q.x, -q.y) < radians(angle) ? -to_side : to_side;
}

// Faces: corners in order, counter-clockwise seen from outside.
using Polyhedron = std::vector<std::vector<dvec3>>;

// Faces of the convex hull of points around the origin: each plane through three points that has all other points on
// one side. The corners of a face are sorted by their direction from the face's centre.
Polyhedron hull(const std::vector<dvec3>& points) {
  Polyhedron faces;
  std::vector<dvec3> normals;
  const auto find = [&](dvec3 a, dvec3 b, dvec3 c) {
    dvec3 n = glm::cross(b - a, c - a);
    if (glm::length(n) < 1e-9) return;
    n = glm::normalize(n);
    std::vector<dvec3> on;
    for (const dvec3 p : points) {
      const double above = glm::dot(p - a, n);
      if (above > 1e-9) return;
      if (above > -1e-9) on.push_back(p);
    }
    for (const dvec3 known : normals) {
      if (glm::dot(known, n) > 1 - 1e-9) return;
    }
    dvec3 middle(0);
    for (const dvec3 p : on) middle += p / double(on.size());
    const dvec3 x = glm::normalize(on[0] - middle), y = glm::cross(n, x);
    const auto direction = [&](dvec3 p) { return std::atan2(glm::dot(p - middle, y), glm::dot(p - middle, x)); };
    std::sort(on.begin(), on.end(), [&](dvec3 p, dvec3 q) { return direction(p) < direction(q); });
    normals.push_back(n);
    faces.push_back(on);
  };
  for (const dvec3 a : points) {
    for (const dvec3 b : points) {
      for (const dvec3 c : points) find(a, b, c);
    }
  }
  return faces;
}

double polyhedron(dvec3 p, const Polyhedron& faces, double scale) {
  double to_planes = -kInfinity, to_faces = kInfinity;
  for (std::vector<dvec3> face : faces) {
    for (dvec3& corner : face) corner *= scale;
    const dvec3 n = glm::normalize(glm::cross(face[1] - face[0], face[2] - face[0]));
    to_planes = std::max(to_planes, glm::dot(p - face[0], n));
    to_faces = std::min(to_faces, distance_to_polygon(p, face));
  }
  return to_planes < 0 ? to_planes : to_faces;
}

// Adds all points (+-x, +-y, +-z) and, if `turning`, their cyclic permutations (z, x, y), (y, z, x).
void add_corners(std::vector<dvec3>& to, dvec3 corner, bool turning) {
  for (int turn = 0; turn < (turning ? 3 : 1); ++turn) {
    for (int signs = 0; signs < 8; ++signs) {
      const dvec3 c = corner * dvec3(signs & 1 ? -1 : 1, signs & 2 ? -1 : 1, signs & 4 ? -1 : 1);
      bool is_new = true;
      for (const dvec3 known : to) is_new = is_new && known != c;
      if (is_new) to.push_back(c);
    }
    corner = dvec3(corner.z, corner.x, corner.y);
  }
}

Polyhedron regular(Kind kind) {
  constexpr double kGoldenRatio = std::numbers::phi;
  std::vector<dvec3> corners;
  switch (kind) {
    case Kind::Tetrahedron:
      corners = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
      break;
    case Kind::Octahedron:
      add_corners(corners, {1, 0, 0}, true);
      break;
    case Kind::Dodecahedron:
      add_corners(corners, {1, 1, 1}, false);
      add_corners(corners, {0, 1 / kGoldenRatio, kGoldenRatio}, true);
      break;
    default:
      add_corners(corners, {0, kGoldenRatio, 1}, true);
  }
  for (dvec3& corner : corners) corner = glm::normalize(corner);
  return hull(corners);
}

double regular_polyhedron(Kind kind, dvec3 p, double radius) {
  static const std::array<Polyhedron, 4> all = {regular(Kind::Tetrahedron), regular(Kind::Octahedron),
                                                regular(Kind::Dodecahedron), regular(Kind::Icosahedron)};
  return polyhedron(p, all[static_cast<std::size_t>(kind) - static_cast<std::size_t>(Kind::Tetrahedron)], radius);
}

double pyramid(dvec3 p, double w, double h) {
  const dvec3 tip(0, h, 0);
  const std::array<dvec3, 4> base = {dvec3(w, -h, w), dvec3(w, -h, -w), dvec3(-w, -h, -w), dvec3(-w, -h, w)};
  Polyhedron faces = {{base[3], base[2], base[1], base[0]}};
  for (std::size_t i = 0; i < 4; ++i) faces.push_back({base[i], base[(i + 1) % 4], tip});
  return polyhedron(p, faces, 1);
}

// The products of sines and cosines written as sums of sines of sums, divided by sqrt(3) k for k radians per unit.
double periodic(Kind kind, dvec3 p, double period) {
  const double k = 2 * std::numbers::pi / period;
  const dvec3 a = p * k;
  double sum;
  if (kind == Kind::Gyroid) {
    sum = 0.5 * (std::sin(a.x + a.y) + std::sin(a.x - a.y) + std::sin(a.y + a.z) + std::sin(a.y - a.z) +
                 std::sin(a.z + a.x) + std::sin(a.z - a.x));
  } else if (kind == Kind::SchwarzP) {
    sum = 3 - 2 * (std::pow(std::sin(a.x / 2), 2) + std::pow(std::sin(a.y / 2), 2) + std::pow(std::sin(a.z / 2), 2));
  } else {
    sum = 0.5 * (std::sin(a.x + a.y - a.z) + std::sin(a.x - a.y + a.z) + std::sin(a.y + a.z - a.x) +
                 std::sin(a.x + a.y + a.z));
  }
  return sum / (std::sqrt(3.0) * k);
}

// For each level: find the cell, of 3^level per side, that contains p or is nearest to p, and the square holes along
// the cell's axes (distance to an axis in the maximum norm). The field is the max of the cube's distance and the
// negated distances of the holes.
double menger_sponge(dvec3 p, double half, int iterations) {
  double d = distance_to_box(p, dvec3(half)), cells = 1;
  for (int level = 0; level < iterations; ++level) {
    const double side = 2 * half / cells;
    dvec3 q;
    for (int axis = 0; axis < 3; ++axis) {
      const double cell = std::clamp(std::floor((p[axis] + half) / side), 0.0, cells - 1);
      q[axis] = std::abs(p[axis] - ((cell + 0.5) * side - half));
    }
    const double to_axis = std::min({std::max(q.x, q.y), std::max(q.y, q.z), std::max(q.z, q.x)});
    d = std::max(d, side / 6 - to_axis);
    cells *= 3;
  }
  return d;
}

// q = u + v j for complex u and v, so that q^2 = u^2 - |v|^2 + (u + conj(u)) v j. The estimate is |q| ln(|q|/R) / (2
// |q'|), but at least the distance to the ball of radius R. Beyond 2 R the field is that distance.
double julia(dvec3 p, Params k) {
  using Complex = std::complex<double>;
  const double c = std::sqrt(k[0] * k[0] + k[1] * k[1] + k[2] * k[2] + k[3] * k[3]);
  const double bound = 0.5 + std::sqrt(0.25 + c), from_ball = glm::length(p) - bound;
  if (from_ball > bound) return from_ball;
  Complex u(p.x, p.y), v(p.z, 0);
  double r = std::sqrt(std::norm(u) + std::norm(v)), slope = 1;
  for (int i = 0; i < static_cast<int>(k[4]) && r < k[5]; ++i) {
    slope *= 2 * r;
    const Complex square = u * u - std::norm(v);
    v = 2 * u.real() * v + Complex(k[2], k[3]);
    u = square + Complex(k[0], k[1]);
    r = std::sqrt(std::norm(u) + std::norm(v));
  }
  return std::max(from_ball, r > 0 ? std::log(r / bound) * r / (2 * slope) : -kInfinity);
}

}  // namespace

std::optional<double> judge_solid(Kind kind, Params k, dvec3 p) {
  switch (kind) {
    case Kind::BoxFrame:
      return box_frame(p, {k[0], k[1], k[2]}, k[3]);
    case Kind::CappedTorus:
      return capped_torus(p, k[0], k[1], k[2]);
    case Kind::InfiniteCylinder:
      return std::hypot(p.x, p.z) - k[0];
    case Kind::InfiniteCone:
      return infinite_cone(p, k[0]);
    case Kind::Capsule:
      return distance_to_segment(p, dvec3(0, -k[1], 0), dvec3(0, k[1], 0)) - k[0];
    case Kind::Tetrahedron:
    case Kind::Octahedron:
    case Kind::Dodecahedron:
    case Kind::Icosahedron:
      return regular_polyhedron(kind, p, k[0]);
    case Kind::Pyramid:
      return pyramid(p, k[0], k[1]);
    case Kind::Gyroid:
    case Kind::SchwarzP:
    case Kind::SchwarzD:
      return periodic(kind, p, k[0]);
    case Kind::MengerSponge:
      return menger_sponge(p, k[0], static_cast<int>(k[1]));
    case Kind::Julia:
      return julia(p, k) - k[6];
    default:
      return std::nullopt;
  }
}

}  // namespace fathom::test
