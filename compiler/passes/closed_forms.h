// Solids by which a ray's first entrance into a piece is known without marching (Roth, "Ray Casting for Modeling
// Solids", 1982): runtime/march/closed_form.h.
// Tested by: tests/runtime/march/closed_form_test.cpp
#pragma once

#include <vector>

#include "compiler/graph/graph.h"
#include "compiler/scene/compiled_scene.h"

namespace fathom::compiler {

// Returns the solids of a node that is an intersection of moved balls, boxes and others without such solids
// (CompiledPiece::forms), or none.
std::vector<ClosedForm> closed_forms(const Graph& graph, NodeId id);

}  // namespace fathom::compiler
