// Proof that triangles lie within a distance of the surface.
//
// Discs of radius r around samples cover the triangle. If the field is positive at the sample moved by +d along the
// triangle's normal and negative at the sample moved by -d, the surface crosses the segment between the two points,
// and every point of the disc is within r + d of the surface. The proof needs no constant of the field, only a field
// without jumps and the bound on its float error. As the signs say which side is outside, a triangle that faces the
// wrong way has no proof.
//
//     DistanceProof proof(field);
//     proof.add(corners);                 // for all triangles in question
//     if (proof.holds(0.01)) ...          // all within 0.01 of the surface
//
// Tested by: tests/runtime/mesh/distance_proof_test.cpp
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <memory>
#include <vector>

#include "runtime/mesh/mesh_field.h"

namespace fathom::runtime {

class DistanceProof {
 public:
  using Corners = std::array<glm::dvec3, 3>;

  explicit DistanceProof(const MeshField& field);

  void clear() { triangles_.clear(); }
  void add(const Corners& corners) { triangles_.push_back(corners); }
  // True if every point of all added triangles is proved within `distance` of the surface, scene units.
  bool holds(double distance);
  std::size_t evaluations() const { return evaluations_; }

 private:
  bool holds_with(const Corners& triangle, double radius, double distance);
  bool check_samples();

  const MeshField& field_;
  std::vector<Corners> triangles_;
  std::vector<Corners> pieces_;  // of a triangle, still to be covered
  PointArrays samples_;          // two per disc: outside, inside
  std::vector<float> values_;
  std::unique_ptr<MeshField::Scratch> scratch_;
  std::size_t evaluations_ = 0;
};

}  // namespace fathom::runtime
