#include "runtime/mesh/distance_proof.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "runtime/mesh/mesh.h"

namespace fathom::runtime {
namespace {

// Radii of the discs, as shares of the distance: first large ones, which need few samples, then small ones.
constexpr double kDiscShares[] = {0.6, 0.3, 0.15};

// Returns the start of a triangle's longest edge.
std::size_t longest_edge(const DistanceProof::Corners& p) {
  std::size_t longest = 0;
  double most = -1;
  for (std::size_t i = 0; i < 3; ++i) {
    const glm::dvec3 edge = p[(i + 1) % 3] - p[i];
    const double square = glm::dot(edge, edge);
    if (square > most) most = square, longest = i;
  }
  return longest;
}

}  // namespace

DistanceProof::DistanceProof(const MeshField& field)
    : field_(field), scratch_(std::make_unique<MeshField::Scratch>()) {}

// Returns a disc around a triangle, the smallest one moved a little into the triangle. The middle of an edge may lie
// on a crease of the surface, where the normal leads along the crease's other side.
DistanceProof::Disc DistanceProof::disc_around(const Corners& p) {
  constexpr double kInward = 0.15;
  const std::size_t longest = longest_edge(p);
  const glm::dvec3 a = p[longest], u = p[(longest + 1) % 3] - a, v = p[(longest + 2) % 3] - a;
  const glm::dvec3 last = v - u;
  const double uu = glm::dot(u, u), vv = glm::dot(v, v);
  glm::dvec3 to = 0.5 * u;
  if (vv + glm::dot(last, last) > uu * (1 + 1e-9)) {  // an acute triangle: the centre of its circumscribed circle
    const glm::dvec3 n = glm::cross(u, v);
    to = (glm::cross(n, u) * vv + glm::cross(v, n) * uu) / (2 * glm::dot(n, n));
  }
  to += kInward * ((u + v) / 3.0 - to);
  return {a + to, std::sqrt(std::max({glm::dot(to, to), glm::dot(to - u, to - u), glm::dot(to - v, to - v)}))};
}

// Covers the pieces by discs of the round's radius and samples them. Pieces without a proof are open afterwards.
void DistanceProof::try_pieces(const Round& round) {
  constexpr std::size_t kDiscs = 256;  // sampled together
  open_.clear();
  while (!pieces_.empty()) {
    const Piece piece = pieces_.back();
    pieces_.pop_back();
    const Corners& p = piece.corners;
    const Disc disc = disc_around(p);
    if (disc.radius <= round.radius) {
      covered_.push_back(piece);
      discs_.push_back(disc);
      if (covered_.size() == kDiscs) sample(round);
      continue;
    }
    const std::size_t longest = longest_edge(p);
    const glm::dvec3 a = p[longest], b = p[(longest + 1) % 3], c = p[(longest + 2) % 3], middle = 0.5 * (a + b);
    pieces_.push_back({{a, middle, c}, piece.normal});
    pieces_.push_back({{middle, b, c}, piece.normal});
  }
  sample(round);
}

void DistanceProof::sample(const Round& round) {
  samples_.clear();
  for (std::size_t i = 0; i < covered_.size(); ++i) {
    const Disc& disc = discs_[i];
    // Rounding to float moves a sample by less than an ulp per coordinate.
    const double rounding = 0x1p-22 * std::max(1e-30, compiler::largest_part(disc.centre));
    const double most = std::min(round.deviation, round.distance - disc.radius);
    const glm::dvec3 offset = (most - rounding) * covered_[i].normal;
    samples_.push_back(disc.centre + offset);
    samples_.push_back(disc.centre - offset);
  }
  values_.resize(samples_.size() + 16);
  field_.evaluate(samples_.from(0), samples_.size(), MeshField::Values::Distance, values_.data(), *scratch_);
  for (std::size_t i = 0; i < covered_.size(); ++i) {
    const bool proved = field_.side(samples_[2 * i], values_[2 * i]) == Side::Outside &&
                        field_.side(samples_[2 * i + 1], values_[2 * i + 1]) == Side::Inside;
    if (!proved) open_.push_back(covered_[i]);
  }
  covered_.clear();
  discs_.clear();
}

// Replaces the normals of the pieces by `share` of the normals plus the field's gradients in their middles, moved by
// `shift` along the normals.
void DistanceProof::turn_to_gradients(double share, double shift) {
  samples_.clear();
  for (const Piece& piece : pieces_) samples_.push_back(disc_around(piece.corners).centre + shift * piece.normal);
  field_.find_surfaces(samples_, gradients_, 1);
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    const glm::dvec3 direction = gradients_[i].normal + share * pieces_[i].normal;
    const double length = glm::length(direction);
    pieces_[i].normal = length > 0 ? direction / length : pieces_[i].normal;
  }
}

// Tries other directions than the normal for the pieces.
void DistanceProof::try_gradients(const Round& round) {
  // Beyond a crease the normal, or the gradient, may run along the surface. Their sum crosses it. Shifts are shares
  // of the distance.
  struct Turn {
    double share, shift;
  };
  constexpr Turn kTurns[] = {{0, 0}, {1, 0}, {1, -0.5}, {1, 0.5}};
  const std::vector<Piece> kept = pieces_;
  for (const Turn& turn : kTurns) {
    pieces_ = kept;
    turn_to_gradients(turn.share, turn.shift * round.distance);
    try_pieces(round);
    if (open_.empty()) return;
  }
  pieces_ = kept;
}

bool DistanceProof::holds(double distance, double deviation, bool any_direction) {
  pieces_.clear();
  for (const Corners& triangle : triangles_) {
    const glm::dvec3 normal = area_normal(triangle);
    const double length = glm::length(normal);
    if (!(length > 0) && !any_direction) return false;
    pieces_.push_back({triangle, length > 0 ? normal / length : glm::dvec3(0)});
  }
  for (const double share : kDiscShares) {
    const Round round{distance, deviation, share * distance};
    try_pieces(round);
    if (open_.empty()) return true;
    std::swap(pieces_, open_);
    if (any_direction) {
      try_gradients(round);
      if (open_.empty()) return true;
    }
    if ((1 - share) * distance >= deviation) return false;  // smaller discs would move the samples no further
  }
  return false;
}

}  // namespace fathom::runtime
