// What is known of every node of a graph (compiler/graph/knowledge.h), by the rows of the node table.
// Tested by: tests/compiler/shapes/bounds_test.cpp, tests/compiler/passes/passes_test.cpp
#pragma once

#include <vector>

#include "compiler/graph/graph.h"
#include "compiler/graph/knowledge.h"

namespace fathom::compiler {

// Given what is known of its children. [child]
Knowledge know(const Graph& graph, NodeId id, const std::vector<Knowledge>& known);

// One entry per node id, children first.
std::vector<Knowledge> analyse(const Graph& graph);

// A box round every bounded part of a node: of a ground with things on it, round the things. Empty when there is
// none.
Box contents(const Graph& graph, NodeId id, const std::vector<Knowledge>& known);

// Whether the node's children are evaluated at the node's own point, and their distances are all it needs.
bool takes_own_point(const Graph& graph, NodeId id);

}  // namespace fathom::compiler
