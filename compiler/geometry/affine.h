// Affine maps as a Transform node holds them: twelve numbers, the rows of the map from the parent's space to the
// child's (3x3 part and translation).
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <span>

#include "compiler/geometry/box.h"

namespace fathom::compiler {

struct Affine {
  std::array<glm::dvec3, 3> rows;
  glm::dvec3 translation;

  static Affine from_params(std::span<const double> twelve);
  std::array<double, 12> params() const;
  glm::dvec3 operator()(glm::dvec3 p) const;
  bool operator==(const Affine& other) const = default;
};

inline const Affine kIdentity{{glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 1)}, glm::dvec3(0)};

// Returns a after b: p -> a(b(p)).
Affine compose(const Affine& a, const Affine& b);
// Returns the inverse map. The linear part must be invertible.
Affine inverse(const Affine& a);
// Returns the smallest axis-aligned box around the image of `box`. An infinite side makes only those axes infinite
// that it maps to.
Box image(const Affine& a, const Box& box);
// Smallest and largest factor by which the linear part stretches a vector (its extreme singular values).
struct SingularValues {
  double least, most;
};
SingularValues singular_values(const Affine& a);
// True if every row has a single non-zero entry, so that boxes map to boxes.
bool is_axis_aligned(const Affine& a);

}  // namespace fathom::compiler
