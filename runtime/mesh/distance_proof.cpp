#include "runtime/mesh/distance_proof.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "runtime/mesh/mesh.h"

namespace fathom::runtime {
namespace {

// Radii of the discs, as shares of the distance: first large ones, which need few samples, then small ones.
constexpr double kDiscShares[] = {0.6, 0.3};
constexpr std::size_t kSampleBatch = 512;

struct Disc {
  glm::dvec3 centre;
  double radius;
};

// Returns the smallest disc around a triangle.
Disc disc_around(const DistanceProof::Corners& p) {
  double most = -1;
  std::size_t longest = 0;
  double squares[3];
  for (std::size_t i = 0; i < 3; ++i) {
    const glm::dvec3 edge = p[(i + 1) % 3] - p[i];
    squares[i] = glm::dot(edge, edge);
    if (squares[i] > most) most = squares[i], longest = i;
  }
  const glm::dvec3 a = p[longest], b = p[(longest + 1) % 3], c = p[(longest + 2) % 3];
  const double others = squares[(longest + 1) % 3] + squares[(longest + 2) % 3];
  if (others <= most * (1 + 1e-9)) return {0.5 * (a + b), 0.5 * std::sqrt(most)};
  // The circumscribed circle of an acute triangle.
  const glm::dvec3 u = b - a, v = c - a, n = glm::cross(u, v);
  const glm::dvec3 to = (glm::cross(n, u) * glm::dot(v, v) + glm::cross(v, n) * glm::dot(u, u)) / (2 * glm::dot(n, n));
  const double radius = std::sqrt(std::max({glm::dot(to, to), glm::dot(to - u, to - u), glm::dot(to - v, to - v)}));
  return {a + to, radius};
}

}  // namespace

DistanceProof::DistanceProof(const MeshField& field) : field_(field), scratch_(std::make_unique<MeshField::Scratch>()) {}

bool DistanceProof::check_samples() {
  const std::size_t count = samples_.size();
  values_.resize(count + 16);
  field_.evaluate(samples_.from(0), count, MeshField::Values::Distance, values_.data(), *scratch_);
  evaluations_ += count;
  for (std::size_t i = 0; i < count; ++i) {
    if (field_.side(samples_[i], values_[i]) != (i % 2 == 0 ? Side::Outside : Side::Inside)) return false;
  }
  samples_.clear();
  return true;
}

// Adds the samples of discs of at most `radius` that cover the triangle, and checks full batches.
bool DistanceProof::holds_with(const Corners& triangle, double radius, double distance) {
  const glm::dvec3 normal = area_normal(triangle);
  const double length = glm::length(normal);
  if (!(length > 0)) return false;
  pieces_.assign(1, triangle);
  while (!pieces_.empty()) {
    const Corners p = pieces_.back();
    pieces_.pop_back();
    const Disc disc = disc_around(p);
    if (disc.radius <= radius) {
      // Rounding to float moves a sample by less than an ulp per coordinate.
      const double rounding = 0x1p-22 * std::max(1e-30, compiler::largest_part(disc.centre));
      const glm::dvec3 offset = (distance - disc.radius - rounding) / length * normal;
      samples_.push_back(disc.centre + offset);
      samples_.push_back(disc.centre - offset);
      if (samples_.size() >= kSampleBatch && !check_samples()) return false;
      continue;
    }
    std::size_t longest = 0;
    double most = -1;
    for (std::size_t i = 0; i < 3; ++i) {
      const double edge = glm::distance(p[i], p[(i + 1) % 3]);
      if (edge > most) most = edge, longest = i;
    }
    const glm::dvec3 a = p[longest], b = p[(longest + 1) % 3], c = p[(longest + 2) % 3], middle = 0.5 * (a + b);
    pieces_.push_back({a, middle, c});
    pieces_.push_back({middle, b, c});
  }
  return true;
}

bool DistanceProof::holds(double distance) {
  for (const double share : kDiscShares) {
    samples_.clear();
    bool held = true;
    for (std::size_t i = 0; held && i < triangles_.size(); ++i) {
      held = holds_with(triangles_[i], share * distance, distance);
    }
    if (held && check_samples()) return true;
  }
  return false;
}

}  // namespace fathom::runtime
