// Tries to refute the Lipschitz constants a scene was compiled with: computes gradients and difference quotients at
// many points, in double, of the whole field, of every object and of every node that has a proof of its own.
//
// Each node is probed in its own space. Half of the points are uniform in its box grown by a fifth (infinite sides
// end at `reach` from the origin). The other half walk from there towards the surface. Points depend on their number
// alone, so results do not depend on the number of threads. A node can have so many uses that its program is very
// long. All rows after the first therefore share a budget: the number of instructions that the first row takes, or
// `min_work` if that is more. A row that starts with too little budget left has no points. No probe proves
// anything, but a probe that breaks a constant refutes it.
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
  std::uint64_t points = 1'000'000;  // of the whole field; all other rows share the same number
  double reach = 50;                 // where infinite sides end, scene units
  glm::dvec3 origin{0};              // centre of `reach` for the scene and its objects, scene units
  int threads = 1;
  std::uint64_t min_work = 100'000'000;  // instructions, minimum budget of the rows after the first
};

struct ProbeRow {
  enum class What { Scene, Object, Node };
  What what;
  NodeId node;
  Place place;
  bool certified;   // only a certified constant can break
  double declared;  // Lipschitz constant
  std::uint64_t points = 0;
  double gradient = 0;        // length of the longest gradient seen
  double quotient = 0;        // largest |f(p) - f(q)| / |p - q| seen, less rounding errors
  glm::dvec3 at{0};           // where the larger of the two was seen, in the node's own space
  std::uint64_t invalid = 0;  // number of points with a NaN value

  double seen() const { return gradient > quotient ? gradient : quotient; }
  double ratio() const { return seen() / declared; }
  bool broken() const;
};

// Returns rows of the scene, its objects in file order, then nodes, children first. `scene` is the graph before the
// first pass. When a constant breaks that no node below accounts for, probes all nodes below, whatever their
// constants.
std::vector<ProbeRow> probe(const Scene& scene, const std::vector<Surface>& surfaces, const ProbeOptions& options);

// Returns the broken rows below which no other row is broken: the nodes with a wrong constant.
std::vector<const ProbeRow*> culprits(const Scene& scene, const std::vector<ProbeRow>& rows);

}  // namespace fathom::compiler
