// Facts about every node of a graph (compiler/graph/node_facts.h), by the rows of the node table.
// Tested by: tests/compiler/shapes/bounds_test.cpp, tests/compiler/passes/passes_test.cpp
#pragma once

#include <vector>

#include "compiler/graph/graph.h"
#include "compiler/graph/node_facts.h"

namespace fathom::compiler {

// Returns the facts about a node. `known` [node] are the facts about its children.
NodeFacts derive_facts(const Graph& graph, NodeId id, const std::vector<NodeFacts>& known);

// Returns the facts about every node, in the order of ids (children first).
std::vector<NodeFacts> analyse(const Graph& graph);

// Returns a box around every bounded part of a node: for a ground with things on it, around the things. Empty if the
// node has no bounded part.
Box contents(const Graph& graph, NodeId id, const std::vector<NodeFacts>& known);

// True if the node's children are evaluated at the node's own point, and their distances are all that the node needs.
bool takes_own_point(const Graph& graph, NodeId id);

}  // namespace fathom::compiler
