// Brute force for the solids of judge_solids.cpp: flat faces and swept arcs as patches.
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <numbers>

#include "tests/support/judge/brute_force.h"
#include "tests/support/judge/judge_geometry.h"

namespace fathom::test {
namespace {

using compiler::Kind;
using glm::dvec2;
using glm::dvec3;

constexpr double kGolden = std::numbers::phi;

// Corners and face normals of a regular polyhedron, up to scale. The normals are the corners of the dual polyhedron.
struct Directions {
  std::vector<dvec3> corners, normals;
};

std::vector<dvec3> turns(const std::vector<dvec3>& some) {
  std::vector<dvec3> all;
  for (const dvec3 v : some) all.insert(all.end(), {v, {v.z, v.x, v.y}, {v.y, v.z, v.x}});
  return all;
}

Directions directions(Kind kind) {
  constexpr double g = kGolden, i = 1 / kGolden;
  const std::vector<dvec3> tetrahedron = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
  std::vector<dvec3> cube = tetrahedron, opposite;
  for (const dvec3 v : tetrahedron) opposite.push_back(-v);
  cube.insert(cube.end(), opposite.begin(), opposite.end());
  const std::vector<dvec3> axes = turns({{1, 0, 0}, {-1, 0, 0}});
  const std::vector<dvec3> icosahedron = turns({{0, g, 1}, {0, g, -1}, {0, -g, 1}, {0, -g, -1}});
  std::vector<dvec3> dodecahedron = turns({{0, i, g}, {0, i, -g}, {0, -i, g}, {0, -i, -g}});
  dodecahedron.insert(dodecahedron.end(), cube.begin(), cube.end());
  if (kind == Kind::Tetrahedron) return {tetrahedron, opposite};
  if (kind == Kind::Octahedron) return {axes, cube};
  if (kind == Kind::Dodecahedron) return {dodecahedron, icosahedron};
  return {icosahedron, dodecahedron};
}

}  // namespace

void BruteForce::add_quad(dvec3 a, dvec3 b, dvec3 c, dvec3 d) {
  add([=](double u, double v) { return (1 - v) * ((1 - u) * a + u * b) + v * ((1 - u) * d + u * c); });
}

// Each face is a fan of triangles around its centre, one per pair of neighbouring corners.
void BruteForce::build_polyhedron(Kind kind, double radius) {
  Directions solid = directions(kind);
  for (dvec3& corner : solid.corners) corner *= radius / glm::length(corner);
  double inradius = 0, shortest = 1e9;
  for (const dvec3 corner : solid.corners) {
    inradius = std::max(inradius, glm::dot(corner, glm::normalize(solid.normals[0])));
    if (corner != solid.corners[0]) shortest = std::min(shortest, glm::length(corner - solid.corners[0]));
  }
  for (const dvec3 direction : solid.normals) {
    const dvec3 normal = glm::normalize(direction);
    std::vector<dvec3> face;
    for (const dvec3 corner : solid.corners) {
      if (glm::dot(corner, normal) > inradius * (1 - 1e-9)) face.push_back(corner);
    }
    for (std::size_t i = 0; i < face.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        if (glm::length(face[i] - face[j]) > shortest * (1 + 1e-9)) continue;
        add_quad(inradius * normal, face[i], face[j], inradius * normal);
      }
    }
  }
  inside_ = [normals = solid.normals, inradius](dvec3 p) {
    for (const dvec3 n : normals) {
      if (glm::dot(p, n) >= inradius * glm::length(n)) return false;
    }
    return true;
  };
}

void BruteForce::build_pyramid(double w, double h) {
  const dvec3 tip(0, h, 0), middle(0, -h, 0);
  for (int i = 0; i < 4; ++i) {
    const double x = i % 2 ? w : -w, z = i / 2 ? w : -w;
    add_quad(middle, {x, -h, 0}, {x, -h, z}, {0, -h, z});
    add_quad(tip, {x, -h, 0}, {x, -h, z}, tip);
    add_quad(tip, {0, -h, z}, {x, -h, z}, tip);
  }
  inside_ = [=](dvec3 p) {  // the cross section is a square
    const double half = w * (h - p.y) / (2 * h);
    return p.y > -h && std::abs(p.x) < half && std::abs(p.z) < half;
  };
}

// For each axis and each of its two ends: the four sides of the face between the edges of the box and of the window,
// and the four walls of the window.
void BruteForce::build_box_frame(dvec3 half, double thickness) {
  const dvec3 window = half - 2 * thickness;
  for (int side = 0; side < 24; ++side) {
    const int axis = side % 3, a = (axis + 1) % 3, b = (axis + 2) % 3;
    const double end = side / 3 % 2 ? 1 : -1;
    const int quarter = side / 6;
    const auto corner = [&](bool outer, bool face, int turn) {
      const double sign_a = (turn + quarter) % 4 < 2 ? 1 : -1, sign_b = (turn + quarter + 1) % 4 < 2 ? 1 : -1;
      dvec3 v;
      v[axis] = end * (face ? half[axis] : window[axis]);
      v[a] = sign_a * (outer ? half[a] : window[a]);
      v[b] = sign_b * (outer ? half[b] : window[b]);
      return v;
    };
    add_quad(corner(true, true, 0), corner(true, true, 1), corner(false, true, 1), corner(false, true, 0));
    add_quad(corner(false, true, 0), corner(false, true, 1), corner(false, false, 1), corner(false, false, 0));
  }
  inside_ = [=](dvec3 p) {
    int beyond_window = 0;
    for (int axis = 0; axis < 3; ++axis) {
      if (std::abs(p[axis]) >= half[axis]) return false;
      beyond_window += std::abs(p[axis]) > window[axis];
    }
    return beyond_window >= 2;
  };
}

// The tube along the arc, and half a ball at each end unless the ring is whole. If the ends overlap, parts of these
// patches lie inside the solid, so distances inside the solid are wrong.
void BruteForce::build_capped_torus(double major, double minor, double degrees) {
  const double angle = degrees * kPi / 180;
  add([=](double u, double v) {
    const double a = angle * (2 * u - 1), b = 2 * kPi * v, rho = major + minor * std::cos(b);
    return dvec3(rho * std::sin(a), rho * std::cos(a), minor * std::sin(b));
  });
  for (const double end : {-1.0, 1.0}) {
    if (degrees == 180) break;
    const dvec3 out(std::sin(end * angle), std::cos(angle), 0), along(end * std::cos(angle), -end * out.x, 0);
    add([=](double u, double v) {
      const double a = kPi / 2 * u, b = 2 * kPi * v;
      return major * out +
             minor * (std::cos(a) * along + std::sin(a) * (std::cos(b) * out + std::sin(b) * dvec3(0, 0, 1)));
    });
  }
  inside_ = [=](dvec3 p) {
    const double rho = std::hypot(p.x, p.y);
    const bool on_arc = rho > 0 && p.y >= rho * std::cos(angle);
    const auto in_ball = [&](dvec3 centre) { return glm::length(p - centre) < minor; };
    return (on_arc && std::hypot(rho - major, p.z) < minor) ||
           in_ball({major * std::sin(angle), major * std::cos(angle), 0}) ||
           in_ball({-major * std::sin(angle), major * std::cos(angle), 0});
  };
}

bool BruteForce::build_solid(Kind kind, std::span<const double> k) {
  constexpr double kFar = 128;  // large enough for points within 64 of the origin
  const auto line = [](dvec2 a, dvec2 b) { return [=](double t) { return (1 - t) * a + t * b; }; };
  switch (kind) {
    case Kind::BoxFrame:
      build_box_frame({k[0], k[1], k[2]}, k[3]);
      return true;
    case Kind::CappedTorus:
      build_capped_torus(k[0], k[1], k[2]);
      return true;
    case Kind::InfiniteCylinder:
      revolve(line({k[0], -kFar}, {k[0], kFar}));
      inside_ = [r = k[0]](dvec3 p) { return p.x * p.x + p.z * p.z < r * r; };
      return true;
    case Kind::InfiniteCone: {
      const double slope = std::tan(k[0] * kPi / 180), far = kFar / std::hypot(1, slope);
      // Eight patches of an eighth turn each: near the tip the compass search only descends in the right direction.
      for (int i = 0; i < 8; ++i) {
        add([=](double u, double v) {
          const double turn = kPi / 4 * (i + v), rho = u * far * slope;
          return dvec3(rho * std::sin(turn), -u * far, rho * std::cos(turn));
        });
      }
      inside_ = [slope](dvec3 p) { return p.y < 0 && p.x * p.x + p.z * p.z < p.y * p.y * slope * slope; };
      return true;
    }
    case Kind::Capsule:
      revolve(line({k[0], -k[1]}, {k[0], k[1]}));
      for (const double end : {-1.0, 1.0}) {
        revolve([=, r = k[0], h = k[1]](double t) {
          return dvec2(r * std::cos(kPi / 2 * t), end * (h + r * std::sin(kPi / 2 * t)));
        });
      }
      inside_ = [r = k[0], h = k[1]](dvec3 p) {
        const double y = p.y - std::clamp(p.y, -h, h);
        return p.x * p.x + y * y + p.z * p.z < r * r;
      };
      return true;
    case Kind::Tetrahedron:
    case Kind::Octahedron:
    case Kind::Dodecahedron:
    case Kind::Icosahedron:
      build_polyhedron(kind, k[0]);
      return true;
    case Kind::Pyramid:
      build_pyramid(k[0], k[1]);
      return true;
    default:
      return false;
  }
}

}  // namespace fathom::test
