// Facts of the regular polyhedra and the pyramid.
#include <cmath>

#include "compiler/shapes/rows.h"
#include "compiler/shapes/solid_facts.h"

namespace fathom::compiler {
namespace {

constexpr double kSqrt2PlusGolden = 1.9021130325903071;  // equals sqrt(1 + golden ratio^2)
constexpr double kGolden = 1.6180339887498949;

}  // namespace

// All functions return the inradius, the apothem of a face and half an edge, for the circumradius p[0].

// Corners (1,1,1), ...: circumradius sqrt 3, a face's centre (1,1,-1)/3, an edge's middle (1,0,0).
std::vector<double> tetrahedron_immediates(Params p) { return {p[0] / 3, p[0] * kSqrt2 / 3, p[0] * kSqrt2 / kSqrt3}; }

// Corners (1,0,0), ...: a face's centre (1,1,1)/3, an edge's middle (1,1,0)/2.
std::vector<double> octahedron_immediates(Params p) { return {p[0] / kSqrt3, p[0] / kSqrt6, p[0] / kSqrt2}; }

// Corners (1,1,1), (0, 1/g, g), ...: circumradius sqrt 3, inradius g^2 / |(0,g,1)|, a face's circumradius 2 /
// |(0,g,1)|, from which the cosine g/2 and the sine sqrt(3-g)/2 of 36 degrees give the apothem and half an edge.
std::vector<double> dodecahedron_immediates(Params p) {
  const double unit = p[0] / kSqrt3;
  return {unit * (kGolden + 1) / kSqrt2PlusGolden, unit * kGolden / kSqrt2PlusGolden, unit / kGolden};
}

// Corners (0, g, 1), ...: circumradius |(0,g,1)|, inradius g^2 / sqrt 3, a face's circumradius 2 / sqrt 3.
std::vector<double> icosahedron_immediates(Params p) {
  const double unit = p[0] / kSqrt2PlusGolden;
  return {unit * (kGolden + 1) / kSqrt3, unit / kSqrt3, unit};
}

std::vector<double> pyramid_immediates(Params p) {
  const double half_width = p[0], height = 2 * p[1];
  const double slant = std::sqrt(height * height + half_width * half_width);
  const double edge = std::sqrt(slant * slant + half_width * half_width);
  return {half_width, p[1], height / slant, half_width / slant, slant / edge, half_width / edge, edge};
}

Box tetrahedron_bound(Params p) { return Box::centred(glm::dvec3(p[0] / kSqrt3)); }
Box dodecahedron_bound(Params p) { return Box::centred(glm::dvec3(p[0] * kGolden / kSqrt3)); }
Box icosahedron_bound(Params p) { return Box::centred(glm::dvec3(p[0] * kGolden / kSqrt2PlusGolden)); }
Box pyramid_bound(Params p) { return Box::centred({p[0], p[1], p[0]}); }

}  // namespace fathom::compiler
