// Conversion of a formula to graph nodes, one node per operation.
// Tested by: tests/compiler/derive/formula_field_test.cpp
#pragma once

#include <span>
#include <string>

#include "compiler/frontend/formula/formula.h"
#include "compiler/graph/graph.h"
#include "compiler/source/diagnostics.h"

namespace fathom::compiler {

// Returns the functions of the node table, from which a formula of x, y and z can be built.
std::span<const FunctionSpec> machine_functions();

// True if float can hold every number in the formula. Reports each number that float cannot hold.
bool holds_in_float(const Formula& formula, Diagnostics& diagnostics);

// Returns the node with the formula's value. `name` is the name of the scene's node that the formula belongs to.
NodeId make_formula(Graph& graph, const Formula& formula, const std::string& name);

}  // namespace fathom::compiler
