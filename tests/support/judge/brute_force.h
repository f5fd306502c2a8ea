// True distances to primitives by brute force. The boundary is a list of parametrised patches, searched on a grid and
// then by a shrinking compass search. The inside test shares no code with that search. Accuracy: about 1e-10 of the
// size of the solid.
//
//     BruteForce truth(Kind::Cone, params);
//     truth.distance(p)      // negative inside
//
// Not for fractals, whose boundary cannot be parametrised, nor for other fields that are not exact distances.
// Tested by: tests/compiler/shapes/shapes_test.cpp
#pragma once

#include <functional>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "compiler/graph/graph.h"

namespace fathom::test {

class BruteForce {
 public:
  BruteForce(compiler::Kind kind, std::span<const double> params);

  double distance(glm::dvec3 p) const;
  bool inside(glm::dvec3 p) const { return inside_(p); }

 private:
  using Map = std::function<glm::dvec3(double u, double v)>;  // maps [0,1]^2 onto a part of the boundary
  struct Patch {
    Map map;
    std::vector<glm::dvec3> nodes;  // grid points: [u][v]
    double cell;                    // longest cell diagonal, scene units
  };

  void add(Map map);
  static double distance_to(const Patch& patch, glm::dvec3 p, double best);

  void build_box(glm::dvec3 half, double rounding);
  void build_revolved(compiler::Kind kind, std::span<const double> k);
  void build_round_cone(double bottom, double top, double height);
  void build_plane(glm::dvec3 normal, double offset);
  void build_sheet(std::span<const double> corners, double thickness);
  // Builds a solid of brute_force_solids.cpp. Returns false for all other primitives.
  bool build_solid(compiler::Kind kind, std::span<const double> k);
  void build_box_frame(glm::dvec3 half, double thickness);
  void build_capped_torus(double major, double minor, double degrees);
  void build_polyhedron(compiler::Kind kind, double radius);
  void build_pyramid(double half_width, double half_height);
  void add_quad(glm::dvec3 a, glm::dvec3 b, glm::dvec3 c, glm::dvec3 d);
  void revolve(std::function<glm::dvec2(double t)> profile);

  std::vector<Patch> patches_;
  std::function<bool(glm::dvec3)> inside_;
  // Added to the solid around the patches (triangle and quad).
  double thickness_ = 0;
};

}  // namespace fathom::test
