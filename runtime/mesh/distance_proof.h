// Proof that triangles lie within a distance of the surface.
//
// Discs of radius r around samples cover the triangle. If the field is positive at the sample moved by +d along the
// triangle's normal and negative at the sample moved by -d, the surface crosses the segment between the two points,
// and every point of the disc is within r + d of the surface. The proof needs no constant of the field, only the
// bound on its float error. As the signs say which side is outside, a triangle that faces the wrong way has no proof.
//
//     DistanceProof proof(field);
//     proof.add(corners);                 // for all triangles in question
//     if (proof.is_near(0.01)) ...          // all within 0.01 of the surface
//
// A disc without a proof is split, because smaller discs allow the surface to be further from their samples.
//
// Tested by: tests/runtime/mesh/distance_proof_test.cpp
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <memory>
#include <vector>

#include "runtime/mesh/lattice/mesh_field.h"

namespace fathom::runtime {

class DistanceProof {
 public:
  using Corners = std::array<glm::dvec3, 3>;

  explicit DistanceProof(const MeshField& field);

  void clear() { triangles_.clear(); }
  void add(const Corners& corners) { triangles_.push_back(corners); }
  // True if every point of all added triangles is proved within `distance` of the surface, and all samples within
  // `deviation`, scene units.
  bool holds(double distance, double deviation) { return holds(distance, deviation, false); }
  // True if every point of all added triangles is proved within `distance` of the surface. Triangles may face any
  // way: where the normal does not lead across the surface, the gradient is tried, and the sum of both.
  bool is_near(double distance) { return holds(distance, distance, true); }

 private:
  // A part of a triangle, with the triangle's unit normal.
  struct Piece {
    Corners corners;
    glm::dvec3 normal;
  };
  struct Disc {
    glm::dvec3 centre;
    double radius;
  };
  // Offsets of the samples in one round.
  struct Round {
    double distance, deviation, radius;
  };

  bool holds(double distance, double deviation, bool any_direction);
  void try_pieces(const Round& round);
  void sample(const Round& round);
  void turn_to_gradients(double share, double shift);
  void try_gradients(const Round& round);
  static Disc disc_around(const Corners& corners);

  const MeshField& field_;
  std::vector<Corners> triangles_;
  std::vector<Piece> pieces_;   // still to be covered by discs
  std::vector<Piece> covered_;  // by one disc each, still to be sampled
  std::vector<Disc> discs_;     // [covered piece]
  std::vector<Piece> open_;     // without a proof
  PointArrays samples_;         // [2 piece] outside, [2 piece + 1] inside
  std::vector<float> values_;
  std::vector<MeshField::SurfacePoint> gradients_;
  std::unique_ptr<MeshField::Scratch> scratch_;
};

}  // namespace fathom::runtime
