// Rows of the solids with flat faces: the regular polyhedra, the pyramid, and the polygons with a thickness.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "compiler/shapes/rows.h"

namespace fathom::compiler {
namespace {

using glm::dvec3;
using vm::Opcode;

constexpr double kSqrt2PlusGolden = 1.9021130325903071;  // equals sqrt(1 + golden ratio^2)
constexpr double kGolden = 1.6180339887498949;

// The immediates of the regular polyhedra are the inradius, the apothem of a face and half an edge, for the
// circumradius p[0].

// Corners (1,1,1), ...: circumradius sqrt 3, a face's centre (1,1,-1)/3, an edge's middle (1,0,0).
std::vector<double> tetrahedron_immediates(Params p) { return {p[0] / 3, p[0] * kSqrt2 / 3, p[0] * kSqrt2 / kSqrt3}; }

NodeSpec tetrahedron_row() {
  return {
      .kind = Kind::Tetrahedron,
      .name = "tetrahedron",
      .category = kPrimitive,
      .params = {length("radius", "of the ball through the corners")},
      .doc = "four corners of a cube with sides across the axes, among them the one where x, y and z are positive",
      .code = code_of<Opcode::Tetrahedron, tetrahedron_immediates>,
      .bound = [](Params p) { return Box::centred(dvec3(p[0] / kSqrt3)); }};
}

// Corners (1,0,0), ...: a face's centre (1,1,1)/3, an edge's middle (1,1,0)/2.
std::vector<double> octahedron_immediates(Params p) { return {p[0] / kSqrt3, p[0] / kSqrt6, p[0] / kSqrt2}; }

NodeSpec octahedron_row() {
  return {.kind = Kind::Octahedron,
          .name = "octahedron",
          .category = kPrimitive,
          .params = {length("radius", "of the ball through the corners, which lie on the axes")},
          .doc = "eight triangles",
          .code = code_of<Opcode::Octahedron, octahedron_immediates>,
          .bound = [](Params p) { return Box::centred(dvec3(p[0])); },
          .facts = kSymmetric};
}

// Corners (1,1,1), (0, 1/g, g), ...: circumradius sqrt 3, inradius g^2 / |(0,g,1)|, a face's circumradius 2 /
// |(0,g,1)|, from which the cosine g/2 and the sine sqrt(3-g)/2 of 36 degrees give the apothem and half an edge.
std::vector<double> dodecahedron_immediates(Params p) {
  const double unit = p[0] / kSqrt3;
  return {unit * (kGolden + 1) / kSqrt2PlusGolden, unit * kGolden / kSqrt2PlusGolden, unit / kGolden};
}

NodeSpec dodecahedron_row() {
  return {.kind = Kind::Dodecahedron,
          .name = "dodecahedron",
          .category = kPrimitive,
          .params = {length("radius", "of the ball through the corners")},
          .doc = "twelve pentagons; an edge at either end of each axis",
          .code = code_of<Opcode::Dodecahedron, dodecahedron_immediates>,
          .bound = [](Params p) { return Box::centred(dvec3(p[0] * kGolden / kSqrt3)); },
          .facts = kSymmetric};
}

// Corners (0, g, 1), ...: circumradius |(0,g,1)|, inradius g^2 / sqrt 3, a face's circumradius 2 / sqrt 3.
std::vector<double> icosahedron_immediates(Params p) {
  const double unit = p[0] / kSqrt2PlusGolden;
  return {unit * (kGolden + 1) / kSqrt3, unit / kSqrt3, unit};
}

NodeSpec icosahedron_row() {
  return {.kind = Kind::Icosahedron,
          .name = "icosahedron",
          .category = kPrimitive,
          .params = {length("radius", "of the ball through the corners")},
          .doc = "twenty triangles; an edge at either end of each axis",
          .code = code_of<Opcode::Icosahedron, icosahedron_immediates>,
          .bound = [](Params p) { return Box::centred(dvec3(p[0] * kGolden / kSqrt2PlusGolden)); },
          .facts = kSymmetric};
}

std::vector<double> pyramid_immediates(Params p) {
  const double half_width = p[0], height = 2 * p[1];
  const double slant = std::sqrt(height * height + half_width * half_width);
  const double edge = std::sqrt(slant * slant + half_width * half_width);
  return {half_width, p[1], height / slant, half_width / slant, slant / edge, half_width / edge, edge};
}

Box pyramid_bound(Params p) { return Box::centred({p[0], p[1], p[0]}); }
NodeSpec pyramid_row() {
  return {.kind = Kind::Pyramid,
          .name = "pyramid",
          .category = kPrimitive,
          .params = {length("half_width", "of the base, along x and z"), length("half_height", "along y")},
          .doc = "a square base at y = -half_height and a tip at y = half_height",
          .code = code_of<Opcode::Pyramid, pyramid_immediates>,
          .bound = pyramid_bound,
          .facts = kUpright,
          .between = Between{"half_height", 0.5}};
}

// Triangles and quads: sheets around the polygon through their corners. The last parameter is the thickness.

std::vector<dvec3> corners(Params p) {
  std::vector<dvec3> result;
  for (std::size_t i = 0; i + 3 <= p.size(); i += 3) result.push_back({p[i], p[i + 1], p[i + 2]});
  return result;
}

double longest_side(const std::vector<dvec3>& v) {
  double longest = 0;
  for (std::size_t i = 0; i < v.size(); ++i) longest = std::max(longest, glm::length(v[(i + 1) % v.size()] - v[i]));
  return longest;
}

// Returns twice the polygon's area as a vector along its normal (Newell's method).
dvec3 area_vector(const std::vector<dvec3>& v) {
  dvec3 sum(0.0);
  for (std::size_t i = 0; i < v.size(); ++i) sum += glm::cross(v[i] - v[0], v[(i + 1) % v.size()] - v[0]);
  return sum;
}

// Returns the corners moved into one plane exactly: a quad's may be off by the tolerance of check_quad().
std::vector<dvec3> flat_corners(Params p) {
  std::vector<dvec3> v = corners(p);
  const dvec3 normal = glm::normalize(area_vector(v));
  for (dvec3& corner : v) corner -= glm::dot(corner - v[0], normal) * normal;
  return v;
}

constexpr const char* kCornerNames = "abcd";

ErrorText check_sheet(const std::vector<dvec3>& v) {
  const double scale = longest_side(v);
  for (std::size_t i = 0; i < v.size(); ++i) {
    for (std::size_t j = i + 1; j < v.size(); ++j) {
      if (glm::length(v[i] - v[j]) <= 1e-9 * scale) {
        return fmt::format("corners `{}` and `{}` coincide; give distinct corners", kCornerNames[i], kCornerNames[j]);
      }
    }
  }
  if (glm::length(area_vector(v)) <= 1e-9 * scale * scale) {
    return "the corners lie on one line; move one off it";
  }
  return std::nullopt;
}

// Returns a frame with the first corner at its origin, the first edge along x and the normal along z; the length of
// the first edge; for each further edge its start, its direction and its length in the frame's xy plane; the
// thickness.
std::vector<double> sheet_immediates(Params p) {
  const std::vector<dvec3> v = flat_corners(p);
  const dvec3 z = glm::normalize(area_vector(v));
  const dvec3 x = glm::normalize(v[1] - v[0]);
  const dvec3 y = glm::cross(z, x);
  std::vector<double> result;
  for (const dvec3& axis : {x, y, z}) {
    result.insert(result.end(), {axis.x, axis.y, axis.z, -glm::dot(axis, v[0])});
  }
  result.push_back(glm::length(v[1] - v[0]));
  for (std::size_t i = 1; i < v.size(); ++i) {
    const dvec3 start = v[i] - v[0], edge = v[(i + 1) % v.size()] - v[i];
    const double length = glm::length(edge);
    result.insert(result.end(), {glm::dot(start, x), glm::dot(start, y), glm::dot(edge, x) / length,
                                 glm::dot(edge, y) / length, length});
  }
  result.push_back(p.back());
  return result;
}

Box sheet_bound(Params p) {
  Box box;
  for (const dvec3& corner : flat_corners(p)) box = unite(box, {corner, corner});
  return box.grown(p.back());
}

// Triangles and quads are evaluated from their corners, which near the surface are no further away than their size.
double sheet_magnitude(Params p) {
  const Box box = sheet_bound(p);
  return glm::length(box.hi - box.lo);
}

NodeSpec triangle_row() {
  return {.kind = Kind::Triangle,
          .name = "triangle",
          .category = kPrimitive,
          .params = {corner("a"), corner("b"), corner("c"), thickness()},
          .doc = "a flat triangle with a thickness",
          .check = [](Params p) { return check_sheet(corners(p)); },
          .code = code_of<Opcode::Triangle, sheet_immediates>,
          .bound = sheet_bound,
          .cancellation = sheet_magnitude};
}

ErrorText check_quad(Params p) {
  const std::vector<dvec3> v = corners(p);
  if (ErrorText complaint = check_sheet(v)) return complaint;
  const dvec3 normal = glm::normalize(area_vector(v));
  const double scale = longest_side(v);
  const double out = std::abs(glm::dot(v[3] - v[0], glm::normalize(glm::cross(v[1] - v[0], v[2] - v[0]))));
  if (!(out <= 1e-6 * scale)) {
    return fmt::format("corner `d` is {:.3g} off the plane of `a`, `b` and `c`; use two triangles", out);
  }
  for (std::size_t i = 0; i < 4; ++i) {
    const dvec3 before = v[i] - v[(i + 3) % 4], after = v[(i + 1) % 4] - v[i];
    if (glm::dot(glm::cross(before, after), normal) <= 0) {
      return fmt::format(
          "the corner at `{}` is not convex; give the corners in order around a convex shape, or use two "
          "triangles",
          kCornerNames[i]);
    }
  }
  return std::nullopt;
}

NodeSpec quad_row() {
  return {.kind = Kind::Quad,
          .name = "quad",
          .category = kPrimitive,
          .params = {corner("a"), corner("b"), corner("c"), corner("d"), thickness()},
          .doc = "a flat convex quadrilateral with a thickness",
          .check = check_quad,
          .code = code_of<Opcode::Quad, sheet_immediates>,
          .bound = sheet_bound,
          .cancellation = sheet_magnitude};
}

}  // namespace

std::vector<NodeSpec> polyhedron_rows() {
  return {tetrahedron_row(), octahedron_row(), dodecahedron_row(), icosahedron_row(),
          pyramid_row(),     triangle_row(),   quad_row()};
}

}  // namespace fathom::compiler
