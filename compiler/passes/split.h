// Splits a scene into pieces, whose union it is. A ray then meets only the pieces whose boxes lie in its way
// (runtime/march/piece_marcher.h).
// Tested by: tests/compiler/passes/split_test.cpp
#pragma once

#include <vector>

#include "compiler/graph/graph.h"
#include "compiler/scene/compiled_scene.h"

namespace fathom::compiler {

// A scene as the union of nodes of one graph, in the order of the scene.
struct Pieces {
  Graph graph;
  std::vector<NodeId> nodes;
};

// Splits the scene after the passes, with or without Paint. Unions divide it. Moves, scales, offsets, cuts and limits
// of a union distribute over its arms: (a | b) - c = (a - c) | (b - c), with the same bits, because rounding is
// monotone. A cut that does not reach an arm is left out of it, which keeps signs but not distances.
//
// A union whose arms are cheap or lie in each other's boxes stays one piece: it is divided if rays that meet boxes in
// proportion to their surface (Goldsmith and Salmon, "Automatic Creation of Object Hierarchies for Ray Tracing", 1987)
// then cost less, or if some arms alone have a proved Lipschitz constant. A cut or a limit that would copy more than
// four times the scene's nodes stays one piece, too.
Pieces split(const Scene& scene);

// True if the node's value is a convex function of the point, as far as the node table shows.
bool is_convex(const Graph& graph, NodeId id);

}  // namespace fathom::compiler
