#include "compiler/geometry/affine.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace fathom::compiler {

using glm::dvec3;

Affine Affine::from_params(std::span<const double> m) {
  return {{dvec3(m[0], m[1], m[2]), dvec3(m[4], m[5], m[6]), dvec3(m[8], m[9], m[10])}, {m[3], m[7], m[11]}};
}

std::array<double, 12> Affine::params() const {
  return {rows[0].x, rows[0].y,     rows[0].z, translation.x, rows[1].x, rows[1].y,
          rows[1].z, translation.y, rows[2].x, rows[2].y,     rows[2].z, translation.z};
}

dvec3 Affine::operator()(dvec3 p) const {
  return dvec3(glm::dot(rows[0], p), glm::dot(rows[1], p), glm::dot(rows[2], p)) + translation;
}

Affine compose(const Affine& a, const Affine& b) {
  Affine result;
  for (std::size_t i = 0; i < 3; ++i) {
    result.rows[i] = a.rows[i].x * b.rows[0] + a.rows[i].y * b.rows[1] + a.rows[i].z * b.rows[2];
  }
  result.translation = a(b.translation);
  return result;
}

Affine inverse(const Affine& a) {
  // Columns of the inverse are cross products of the rows over the determinant.
  const dvec3 c0 = glm::cross(a.rows[1], a.rows[2]), c1 = glm::cross(a.rows[2], a.rows[0]),
              c2 = glm::cross(a.rows[0], a.rows[1]);
  const double determinant = glm::dot(a.rows[0], c0);
  Affine result{{dvec3(c0.x, c1.x, c2.x) / determinant, dvec3(c0.y, c1.y, c2.y) / determinant,
                 dvec3(c0.z, c1.z, c2.z) / determinant},
                dvec3(0.0)};
  result.translation = -result(a.translation);
  return result;
}

Box image(const Affine& a, const Box& box) {
  if (box.empty()) return box;
  Box result{a.translation, a.translation};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const double m = a.rows[static_cast<std::size_t>(i)][j];
      if (m == 0) continue;  // 0 times an infinite side is 0
      const double p = m * box.lo[j], q = m * box.hi[j];
      result.lo[i] += std::min(p, q);
      result.hi[i] += std::max(p, q);
    }
  }
  return result;
}

namespace {

// Returns the largest singular value, by Jacobi's method on the symmetric matrix of the rows' dot products (Golub &
// Van Loan, "Matrix Computations", 8.5).
double max_singular_value(const Affine& a) {
  double m[3][3];
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) m[i][j] = glm::dot(a.rows[i], a.rows[j]);
  }
  constexpr int kPairs[3][2] = {{0, 1}, {0, 2}, {1, 2}};
  for (int sweep = 0; sweep < 12; ++sweep) {
    for (const auto& [p, q] : kPairs) {
      if (m[p][q] == 0) continue;
      const double theta = (m[q][q] - m[p][p]) / (2 * m[p][q]);
      const double t = (theta >= 0 ? 1 : -1) / (std::abs(theta) + std::sqrt(theta * theta + 1));
      const double c = 1 / std::sqrt(t * t + 1), s = t * c;
      for (auto& row : m) {
        const double x = row[p], y = row[q];
        row[p] = c * x - s * y;
        row[q] = s * x + c * y;
      }
      for (int k = 0; k < 3; ++k) {
        const double x = m[p][k], y = m[q][k];
        m[p][k] = c * x - s * y;
        m[q][k] = s * x + c * y;
      }
    }
  }
  return std::sqrt(std::max({m[0][0], m[1][1], m[2][2]}));
}

}  // namespace

// Computes the smallest singular value from the inverse: squaring loses the digits of a small singular value next to
// a large one.
SingularValues singular_values(const Affine& a) {
  return {1 / max_singular_value(inverse(a)), max_singular_value(a)};
}

bool is_axis_aligned(const Affine& a) {
  return std::all_of(a.rows.begin(), a.rows.end(),
                     [](const dvec3& row) { return (row.x != 0) + (row.y != 0) + (row.z != 0) == 1; });
}

}  // namespace fathom::compiler
