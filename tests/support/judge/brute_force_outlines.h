// True distances to outlines by brute force: the boundary's pieces as curves, searched at many points and then by a
// shrinking compass; inside where a ray crosses the boundary an odd number of times. Shares the list of pieces with
// the judge, and neither its distances nor its inside tests: a piece too many or too few is noticed. Tested by:
// tests/compiler/shapes/shapes_test.cpp
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
  // On none is the height over the ray's direction greatest or least but at an end.
  struct Curve {
    glm::dvec2 base, cosine, sine;  // base + cosine * cos t + sine * sin t, or base + cosine * t when straight
    bool straight;
    double from, to;
    std::vector<glm::dvec2> nodes;
    double longest;  // distance between neighbouring nodes, scene units
    glm::dvec2 at(double t) const;
  };
  void add(Curve curve);

  std::vector<Curve> curves_;
};

}  // namespace fathom::test
