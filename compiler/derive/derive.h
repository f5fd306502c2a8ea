// Derive: the step from nodes as described to nodes with all their numbers.
//
// A described node has the parameters of its row in the node table and no others. Derive expands nodes that are made
// of others, proves the bounds of formulas (compiler/derive/formula_field.h), computes the numbers that a node takes from
// its children, such as the radius of a twist, and reports children that a node cannot have.
// Tested by: tests/compiler/frontend/elaborate/elaborate_test.cpp, tests/golden (diagnostics E0302, E0312)
#pragma once

#include <optional>
#include <span>

#include "compiler/graph/graph.h"
#include "compiler/source/diagnostics.h"
#include "compiler/source/limits.h"

namespace fathom::compiler {

// nullopt after reporting an error. `type_spans`: [node of `described`] the places of errors; nodes past its end have
// none and are not checked.
std::optional<Scene> derive(const Scene& described, std::span<const Span> type_spans, const Limits& limits,
                            Diagnostics& diagnostics);

}  // namespace fathom::compiler
