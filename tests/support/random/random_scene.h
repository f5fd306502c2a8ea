// Seeded random shapes, graphs and points: every kind of node, with the extremes at which formulas fail (tips of
// cones, fat and thin rings, balls of nearly equal reach, blends of width 0, squashed spaces).
//
// Parameters of shapes are exact in float, so that a float evaluator is judged on the same solid. A seed gives the
// same scene with every standard library, because none of its distributions is used, but not with every compiler:
// parameters and children of a node are drawn as arguments of one call.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "compiler/graph/graph.h"
#include "compiler/shapes/make_node.h"
#include "compiler/shapes/node_table.h"

namespace fathom::test {

// SplitMix64 (Steele, Lea, Flood, "Fast Splittable Pseudorandom Number Generators", 2014).
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  // The first draws are functions of two bytes each, in order, so that changing a byte changes one draw.
  explicit Random(std::span<const std::uint8_t> draws) : state_(draws.size()), draws_(draws) {}
  std::uint64_t bits();
  double uniform(double lo, double hi);  // [lo, hi)
  double length(double lo, double hi);   // log-uniform, exact in float
  int below(int n);                      // 0 .. n-1
  bool chance(double probability) { return uniform(0, 1) < probability; }
  glm::dvec3 in_box(double half);  // uniform, exact in float
  glm::dvec3 direction();          // uniform on the unit sphere

 private:
  std::uint64_t state_;
  std::span<const std::uint8_t> draws_;
};

// Primitives of one sort that are nodes of a graph. Distance estimates (Mandelbulbs and similar fractals) are
// included only if `estimates`.
std::vector<compiler::Kind> primitive_kinds(compiler::Sort sort, bool estimates);

// Returns valid parameters for a primitive of size about 1.
std::vector<double> random_params(compiler::Kind kind, Random& random);

struct GraphOptions {
  int depth = 4;
  bool mandelbulbs = false;
  bool planes = true;    // unbounded parts
  bool paints = true;    // surface numbers 1 .. 6
  bool squash = true;    // non-uniform scales
  bool outlines = true;  // extruded and revolved
  bool formulas = true;  // formulas as solids and as displacements
  // Nodes that fold, repeat or bend space, and combinators that join operands at an edge.
  bool bends = true;
};
compiler::Scene random_scene(Random& random, const GraphOptions& options = {});

// Returns a formula in x, y and z, with slopes from a thousandth to about twenty near the origin.
compiler::NodeId random_formula(compiler::NodeMaker& maker, Random& random);

// Returns a random node that folds, repeats or bends space, over `child`; `child` itself where the node would be
// invalid.
compiler::NodeId random_domain_node(compiler::NodeMaker& maker, Random& random, compiler::NodeId child);

// Rows of a Transform: the child is scaled, rotated by `angle` (radians) about `axis`, then translated.
std::vector<double> transform_params(glm::dvec3 scale, glm::dvec3 axis, double angle, glm::dvec3 translate);

// Returns a graph of one primitive.
compiler::Scene single(compiler::Kind kind, const std::vector<double>& params);

}  // namespace fathom::test
