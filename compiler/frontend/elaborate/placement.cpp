#include "compiler/frontend/elaborate/placement.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "compiler/geometry/direction.h"
#include "vm/number/real.h"

namespace fathom::compiler {
glm::dmat3 rotation_about(glm::dvec3 axis, double degrees) {
  const glm::dvec3 u = direction(axis);
  const auto [s, c] = vm::real::sin_cos_degrees(degrees);
  // Rodrigues' formula: R v = c v + s (u x v) + (1 - c) u (u . v); column j is R e_j.
  glm::dmat3 r;
  for (int j = 0; j < 3; ++j) {
    glm::dvec3 e(0);
    e[j] = 1;
    r[j] = c * e + s * glm::cross(u, e) + (1 - c) * u[j] * u;
  }
  return r;
}

glm::dmat3 rotation_xyz(glm::dvec3 degrees) {
  return rotation_about({0, 0, 1}, degrees.z) * rotation_about({0, 1, 0}, degrees.y) *
         rotation_about({1, 0, 0}, degrees.x);
}

std::array<double, 13> transform_params(glm::dvec3 scale, const glm::dmat3& rotation, glm::dvec3 translation) {
  // p = R S q + t, so q = S^-1 R^T (p - t): row i is column i of R divided by the i-th scale.
  std::array<double, 13> params{};
  for (int i = 0; i < 3; ++i) {
    const glm::dvec3 row = rotation[i] / scale[i];
    const auto at = static_cast<std::size_t>(4 * i);
    for (int j = 0; j < 3; ++j) params[at + static_cast<std::size_t>(j)] = row[j];
    params[at + 3] = -glm::dot(row, translation);
  }
  params[12] = std::min({scale.x, scale.y, scale.z});
  return params;
}

std::array<double, 13> placed_between(glm::dvec3 from, glm::dvec3 to, double share) {
  const glm::dvec3 along = direction(to - from);
  // Any perpendicular direction will do. Crossing with the axis of smaller component keeps the result well
  // conditioned.
  glm::dvec3 other(0);
  other[std::abs(along.x) <= std::abs(along.z) ? 0 : 2] = 1;
  const glm::dvec3 across = glm::normalize(glm::cross(along, other));
  const glm::dmat3 rotation(across, along, glm::cross(across, along));
  return transform_params(glm::dvec3(1), rotation, to - share * (to - from));
}

std::optional<std::array<double, 13>> read_placement(const RecordReader& reader, const Scope& scope,
                                                     Diagnostics& diagnostics) {
  const syntax::Value* scale = reader.value("scale");
  const syntax::Value* rotate = reader.value("rotate");
  glm::dmat3 rotation(1);
  if (rotate) {
    if (const auto* record = std::get_if<syntax::Record>(&rotate->data)) {
      const RecordReader turn(rotation_record(), *record, opening(rotate->span), scope, diagnostics, "E0301");
      if (turn.good()) rotation = rotation_about(turn.vec3("axis"), turn.number("angle"));
    } else {
      rotation = rotation_xyz(*three_numbers(*rotate));
    }
  }
  if (!scale && !rotate && !reader.value("translate")) return std::nullopt;
  const glm::dvec3 factors = scale ? *three_numbers(*scale) : glm::dvec3(1);
  return transform_params(factors, rotation, reader.vec3("translate"));
}

}  // namespace fathom::compiler
