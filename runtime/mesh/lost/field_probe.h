// Single points of a mesh's field: sides, zero-free balls, ways to the surface along lines.
// Tested by: tests/runtime/mesh/mesh_counts_test.cpp
#pragma once

#include <glm/geometric.hpp>
#include <span>
#include <vector>

#include "runtime/mesh/lattice/mesh_field.h"

namespace fathom::runtime {

// A point with what one evaluation says of it.
struct ProbedPoint {
  glm::dvec3 place;  // rounded to float
  double value;      // the field
  double radius;     // of a ball around the point that has no zero, scene units
  Side side;
};

class FieldProbe {
 public:
  // `field` must outlive this object, which belongs to one thread.
  explicit FieldProbe(const MeshField& field);

  ProbedPoint at(glm::dvec3 place);
  // Replaces `out` by the places' points.
  void at(std::span<const glm::dvec3> places, std::vector<ProbedPoint>& out);
  // Outward unit normal, zero where undefined, and the surface.
  MeshField::SurfacePoint surface_at(glm::dvec3 place);

  // Returns the distance along a unit direction at which the line leaves the side of `from`, at most `most`.
  double way_out(const ProbedPoint& from, glm::dvec3 direction, double most);

 private:
  const MeshField& field_;
  MeshField::Scratch scratch_;
  PointArrays points_;
  std::vector<float> values_, radii_;
  std::vector<MeshField::SurfacePoint> surfaces_;
  std::vector<ProbedPoint> one_;
};

inline Side opposite(Side side) { return static_cast<Side>(-static_cast<int>(side)); }

}  // namespace fathom::runtime
