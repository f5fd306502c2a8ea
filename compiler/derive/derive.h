// Derive: the step from nodes as a scene describes them to nodes with all their numbers.
//
// A described node has exactly the parameters of its row in the node table. Derive expands nodes that are composed of
// other nodes, proves the bounds of formulas (compiler/derive/formula_field.h), computes the numbers that a node
// takes from its children, such as the radius of a twist, and reports children that a node cannot have.
// Tested by: tests/compiler/frontend/elaborate/elaborate_test.cpp, tests/golden (diagnostics E0302, E0312)
#pragma once

#include <optional>
#include <span>

#include "compiler/graph/graph.h"
#include "compiler/source/diagnostics.h"
#include "compiler/source/limits.h"

namespace fathom::compiler {

// Returns nullopt after reporting an error. `type_spans` [node of `described`] are the places of errors. Nodes past
// the end of `type_spans` have no place, and Derive does not check how often they evaluate or iterate.
std::optional<Scene> derive(const Scene& described, std::span<const Span> type_spans, const Limits& limits,
                            Diagnostics& diagnostics);

}  // namespace fathom::compiler
