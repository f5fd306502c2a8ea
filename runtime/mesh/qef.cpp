#include "runtime/mesh/qef.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace fathom::runtime {
namespace {

struct EigenSystem {
  std::array<double, 3> values;
  std::array<glm::dvec3, 3> vectors;
};

// Returns eigenvalues and eigenvectors of a symmetric matrix by Jacobi rotations. Source: Golub and Van Loan, "Matrix
// computations", 1996, 8.4.
EigenSystem decompose(const std::array<double, 6>& a) {
  double m[3][3] = {{a[0], a[1], a[2]}, {a[1], a[3], a[4]}, {a[2], a[4], a[5]}};
  double v[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  constexpr int kSweeps = 12;
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    const double off = m[0][1] * m[0][1] + m[0][2] * m[0][2] + m[1][2] * m[1][2];
    if (!(off > 1e-30 * (m[0][0] * m[0][0] + m[1][1] * m[1][1] + m[2][2] * m[2][2]))) break;
    for (int p = 0; p < 2; ++p) {
      for (int q = p + 1; q < 3; ++q) {
        if (m[p][q] == 0) continue;
        const double theta = (m[q][q] - m[p][p]) / (2 * m[p][q]);
        const double t = (theta >= 0 ? 1 : -1) / (std::fabs(theta) + std::sqrt(theta * theta + 1));
        const double c = 1 / std::sqrt(t * t + 1), s = t * c;
        for (int k = 0; k < 3; ++k) {
          const double kp = m[k][p], kq = m[k][q];
          m[k][p] = c * kp - s * kq, m[k][q] = s * kp + c * kq;
        }
        for (int k = 0; k < 3; ++k) {
          const double pk = m[p][k], qk = m[q][k];
          m[p][k] = c * pk - s * qk, m[q][k] = s * pk + c * qk;
          const double kp = v[k][p], kq = v[k][q];
          v[k][p] = c * kp - s * kq, v[k][q] = s * kp + c * kq;
        }
      }
    }
  }
  EigenSystem system{};
  for (int i = 0; i < 3; ++i) {
    system.values[static_cast<std::size_t>(i)] = m[i][i];
    system.vectors[static_cast<std::size_t>(i)] = {v[0][i], v[1][i], v[2][i]};
  }
  return system;
}

}  // namespace

void Quadric::add_plane(glm::dvec3 n, glm::dvec3 point, double plane_weight) {
  const double offset = glm::dot(n, point), w = plane_weight;
  a[0] += w * n.x * n.x, a[1] += w * n.x * n.y, a[2] += w * n.x * n.z;
  a[3] += w * n.y * n.y, a[4] += w * n.y * n.z, a[5] += w * n.z * n.z;
  b += w * offset * n;
  c += w * offset * offset;
  weight += w;
}

Quadric& Quadric::operator+=(const Quadric& other) {
  for (std::size_t i = 0; i < a.size(); ++i) a[i] += other.a[i];
  b += other.b, c += other.c, weight += other.weight;
  return *this;
}

glm::dvec3 Quadric::times(glm::dvec3 x) const {
  return {a[0] * x.x + a[1] * x.y + a[2] * x.z, a[1] * x.x + a[3] * x.y + a[4] * x.z,
          a[2] * x.x + a[4] * x.y + a[5] * x.z};
}

double Quadric::at(glm::dvec3 x) const { return std::max(0.0, glm::dot(x, times(x)) - 2 * glm::dot(b, x) + c); }

glm::dvec3 minimise(const Quadric& quadric, glm::dvec3 centre, double flat) {
  const EigenSystem system = decompose(quadric.a);
  const double most = *std::max_element(system.values.begin(), system.values.end());
  const glm::dvec3 rest = quadric.b - quadric.times(centre);
  glm::dvec3 x = centre;
  for (std::size_t i = 0; i < 3; ++i) {
    if (system.values[i] > flat * most && system.values[i] > 0) {
      x += glm::dot(rest, system.vectors[i]) / system.values[i] * system.vectors[i];
    }
  }
  return x;
}

glm::dvec3 minimise_within(const Quadric& quadric, glm::dvec3 centre, const compiler::Box& box, double flat) {
  const glm::dvec3 free = minimise(quadric, centre, flat);
  if (box.contains(free)) return free;
  // Descent along one coordinate after the other, which a box does not disturb. The added share of `centre` makes it
  // converge where the planes leave a direction free.
  constexpr int kRounds = 48;
  constexpr double kPull = 1e-2;
  const double pull = kPull * quadric.trace() + 1e-300;
  const std::array<std::array<double, 3>, 3> m = {{{quadric.a[0], quadric.a[1], quadric.a[2]},
                                                   {quadric.a[1], quadric.a[3], quadric.a[4]},
                                                   {quadric.a[2], quadric.a[4], quadric.a[5]}}};
  glm::dvec3 x = glm::clamp(free, box.lo, box.hi);
  for (int round = 0; round < kRounds; ++round) {
    for (int i = 0; i < 3; ++i) {
      const auto& row = m[static_cast<std::size_t>(i)];
      double sum = quadric.b[i] + pull * centre[i];
      for (int k = 0; k < 3; ++k) {
        if (k != i) sum -= row[static_cast<std::size_t>(k)] * x[k];
      }
      x[i] = std::clamp(sum / (row[static_cast<std::size_t>(i)] + pull), box.lo[i], box.hi[i]);
    }
  }
  return x;
}

}  // namespace fathom::runtime
