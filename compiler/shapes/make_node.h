// Makes nodes as a scene describes them: expands those that are made of others, derives what a node needs to know of
// its children, and keeps what is known of every node at hand.
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

  // `params` are those of the kind's row. The node must be sound: see complaint().
  NodeId make(Kind kind, Params params, std::span<const NodeId> children, const Origin& origin = {});

  // What is wrong with such a node over these children; nullopt when nothing is. `params` passed the row's `check`.
  Complaint complaint(Kind kind, Params params, std::span<const NodeId> children);

  const Knowledge& known(NodeId id);
  const Graph& graph() const { return graph_; }

 private:
  std::vector<Knowledge> known_of(std::span<const NodeId> children);

  Graph& graph_;
  std::vector<Knowledge> known_;  // [node], of the first nodes
};

}  // namespace fathom::compiler
