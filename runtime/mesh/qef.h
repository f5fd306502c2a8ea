// The point nearest to some planes in the sense of least squares, within a box: the vertex of a cell, and of a
// collapsed edge.
//
// Sources: Ju et al., "Dual contouring of Hermite data", 2002; Garland and Heckbert, "Surface simplification using
// quadric error metrics", 1997; Schaefer, Ju and Warren, "Manifold dual contouring", 2007.
// Tested by: tests/runtime/mesh/qef_test.cpp
#pragma once

#include <array>
#include <glm/vec3.hpp>

#include "compiler/geometry/box.h"

namespace fathom::runtime {

// The sum of squared distances to planes as a function of a point x: x' A x - 2 b x + c, A symmetric.
struct Quadric {
  std::array<double, 6> a{};  // xx, xy, xz, yy, yz, zz
  glm::dvec3 b{0};
  double c = 0;
  double weight = 0;  // sum of the planes' weights

  // Adds the plane through `point` with a unit normal.
  void add_plane(glm::dvec3 normal, glm::dvec3 point, double plane_weight = 1);
  Quadric& operator+=(const Quadric& other);
  // Returns the sum of squared distances, at least 0.
  double at(glm::dvec3 x) const;
  glm::dvec3 times(glm::dvec3 x) const;  // A x
  double trace() const { return a[0] + a[3] + a[5]; }
};

// Returns the point of least error nearest to `centre`. Directions in which the planes agree within `flat`, as a
// share of the largest eigenvalue of A, count as free.
glm::dvec3 minimise(const Quadric& quadric, glm::dvec3 centre, double flat);

// Returns the point of the box with the least error, or nearly.
glm::dvec3 minimise_within(const Quadric& quadric, glm::dvec3 centre, const compiler::Box& box, double flat);

}  // namespace fathom::runtime
