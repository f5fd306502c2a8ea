// The judge: what a scene graph means, in plain doubles and with formulas of its own. It is the one list of meanings
// that is written twice on purpose, since evaluators that share a meaning cannot catch a wrong one. Slow, obvious,
// recursive; never shipped.
//
//     Verdict v = judge(scene.graph, scene.root, p);      // v.distance, v.surface, v.margin
//
// Solids of revolution are judged in the half-plane (rho, y), rho = distance from the y axis, as distances to their
// profile; balls and boxes by their nearest point; smooth blends by the minimum that defines them.
// Not judged: gradients (tests take differences), ranges (tests sample).
// Tested by: tests/compiler/shapes/shapes_test.cpp (against tests/support/judge/brute_force.h)
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>

#include "compiler/graph/graph.h"

namespace fathom::test {

struct Verdict {
  double distance;        // of the node's field, in the space of p
  std::uint32_t surface;  // number of the innermost paint around the winning primitive; 0 when there is none
  double margin;          // from the nearest tie between operands, scene units; infinite without choices
  glm::dvec3 place{0};    // p in the coordinates of that paint; p itself when there is none
};

Verdict judge(const compiler::Graph& graph, compiler::NodeId node, glm::dvec3 p);
double judge_distance(const compiler::Graph& graph, compiler::NodeId node, glm::dvec3 p);
std::uint32_t judge_surface(const compiler::Graph& graph, compiler::NodeId node, glm::dvec3 p);

}  // namespace fathom::test
