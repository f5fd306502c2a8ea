// The judge: the meaning of a scene graph, in plain double arithmetic and with its own formulas. The judge is the one
// list of meanings that is written twice on purpose: evaluators that share a meaning cannot detect a wrong one. The
// judge is slow, obvious, recursive and never shipped.
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
  double distance;  // value of the node's field, in the space of p
  // Number of the innermost paint around the winning primitive; 0 without paint.
  std::uint32_t surface;
  // Gap to the nearest tie between operands, scene units; infinite without choices.
  double margin;
  glm::dvec3 place{0};  // p in the coordinates of that paint; p itself without paint
};

Verdict judge(const compiler::Graph& graph, compiler::NodeId node, glm::dvec3 p);
double judge_distance(const compiler::Graph& graph, compiler::NodeId node, glm::dvec3 p);
std::uint32_t judge_surface(const compiler::Graph& graph, compiler::NodeId node, glm::dvec3 p);

}  // namespace fathom::test
