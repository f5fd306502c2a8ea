// Tries to refute the Lipschitz constants a scene was compiled with: gradients and difference quotients at many
// points, in double, of the whole field, of every object and of every node that has a proof of its own.
//
// Each node is probed in its own space: half of the points uniform in its box grown by a fifth (infinite sides end at
// `reach` from the origin), half walked from there towards the surface. Points depend on their number alone, so
// results do not depend on the number of threads. A node may be used in so many ways that its program is very long:
// all rows after the first take no more instructions together than the first, or `least_work` if that is more, and a
// row that comes when too few are left has no points. No probe proves anything; one that breaks a constant refutes
// it.
//
//     const std::vector<ProbeRow> rows = probe(scene, surfaces, {.points = 1'000'000, .reach = 50});
//
// Tested by: tests/compiler/analysis/probe_test.cpp
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "compiler/analysis/report.h"

namespace fathom::compiler {

struct ProbeOptions {
  std::uint64_t points = 1'000'000;  // in the whole field, and as many again shared out among all other rows
  double reach = 50;                 // scene units
  glm::dvec3 origin{0};              // of the scene's and the objects' endless sides, scene units
  int threads = 1;
  std::uint64_t least_work = 100'000'000;  // instructions
};

struct ProbeRow {
  enum class What { Scene, Object, Node };
  What what;
  NodeId node;
  Place place;
  bool certified;   // only a certified constant can break
  double declared;  // Lipschitz constant
  std::uint64_t points = 0;
  double gradient = 0;        // the longest seen
  double quotient = 0;        // the largest |f(p) - f(q)| / |p - q| seen, rounding taken off
  glm::dvec3 at{0};           // where the larger of the two was seen, in the node's own space
  std::uint64_t invalid = 0;  // points where the value is no number

  double seen() const { return gradient > quotient ? gradient : quotient; }
  double ratio() const { return seen() / declared; }
  bool broken() const;
};

// The scene, its objects in file order, then nodes, children first. `scene` is the graph before the first pass. When
// a constant breaks that no node below accounts for, the nodes below are probed too, whatever their constants.
std::vector<ProbeRow> probe(const Scene& scene, const std::vector<Surface>& surfaces, const ProbeOptions& options);

// The broken rows below which no other is broken: where the wrong constant is.
std::vector<const ProbeRow*> culprits(const Scene& scene, const std::vector<ProbeRow>& rows);

}  // namespace fathom::compiler
