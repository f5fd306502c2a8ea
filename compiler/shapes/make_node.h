// Makes nodes as a scene describes them: expands nodes that are composed of others, derives the numbers that a node
// takes from its children, and keeps the facts about every node at hand.
//
//     NodeMaker maker(graph);
//     const NodeId ball = maker.make(Kind::Sphere, {{1.0}}, {});
//     maker.known(ball).box
//
// Tested by: tests/compiler/shapes/shapes_test.cpp
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "compiler/graph/graph.h"
#include "compiler/shapes/bounds.h"
#include "compiler/shapes/node_table.h"

namespace fathom::compiler {

class NodeMaker {
 public:
  explicit NodeMaker(Graph& graph) : graph_(graph) {}

  // `params` are those of the kind's row. complaint() must have nothing against the node.
  NodeId make(Kind kind, Params params, std::span<const NodeId> children, const SourceLocation& origin = {});

  // Returns the fault of such a node over these children, or nullopt. `params` have passed the row's `check`.
  ErrorText complaint(Kind kind, Params params, std::span<const NodeId> children);

  const NodeFacts& known(NodeId id);
  const Graph& graph() const { return graph_; }

 private:
  std::vector<NodeFacts> known_of(std::span<const NodeId> children);

  Graph& graph_;
  std::vector<NodeFacts> known_;  // [node] facts about the first nodes, as far as asked for
};

}  // namespace fathom::compiler
