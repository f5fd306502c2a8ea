// True distances to outlines by brute force. The pieces of the boundary are curves, searched at many points and then
// by a shrinking compass search. A point is inside if a ray from it crosses the boundary an odd number of times. The
// list of pieces is shared with the judge, the distances and inside tests are not, so a missing or superfluous piece
// is noticed.
// Tested by: tests/compiler/shapes/shapes_test.cpp
#pragma once

#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "compiler/graph/graph.h"

namespace fathom::test {

class BruteForceOutline {
 public:
  BruteForceOutline(compiler::Kind kind, std::span<const double> params);

  double distance(glm::dvec2 p) const;
  bool inside(glm::dvec2 p) const;

 private:
  // Curve on which the height over the ray's direction has its extrema at the ends only.
  struct Curve {
    // base + cosine * cos t + sine * sin t, or base + cosine * t when straight.
    glm::dvec2 base, cosine, sine;
    bool straight;
    double from, to;
    std::vector<glm::dvec2> nodes;
    double longest;  // max distance between neighbouring nodes, scene units
    glm::dvec2 at(double t) const;
  };
  void add(Curve curve);

  std::vector<Curve> curves_;
};

}  // namespace fathom::test
