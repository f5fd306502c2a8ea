// From a formula to nodes of the graph, one for each of its operations.
// Tested by: tests/compiler/derive/formula_field_test.cpp
#pragma once

#include <span>
#include <string>

#include "compiler/frontend/formula/formula.h"
#include "compiler/graph/graph.h"
#include "compiler/source/diagnostics.h"

namespace fathom::compiler {

// The functions of the node table: what a formula of x, y and z can be made of.
std::span<const FunctionSpec> machine_functions();

// Whether float can hold every number in it; reports each that it cannot.
bool holds_in_float(const Formula& formula, Diagnostics& diagnostics);

// The node that is the formula's value. `name` is that of the scene's node it belongs to.
NodeId make_formula(Graph& graph, const Formula& formula, const std::string& name);

}  // namespace fathom::compiler
