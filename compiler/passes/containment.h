// Operands of hard combinators that change nothing, as far as boxes and one interval evaluation show.
// compiler/passes/cull.cpp removes these operands, and compiler/analysis/lints.cpp warns about them. Tested by:
// tests/compiler/passes/passes_test.cpp, tests/golden/diagnostics (W0501, W0502, W0503)
#pragma once

#include <cstddef>
#include <optional>
#include <unordered_map>
#include <vector>

#include "compiler/graph/graph.h"
#include "compiler/graph/node_facts.h"
#include "vm/interpret/evaluate.h"

namespace fathom::compiler {

// Works on one graph, which may grow between calls.
class Containment {
 public:
  // Maximum length of a list whose operands are compared in pairs; the renderer deals with longer lists.
  static constexpr std::size_t kLongestList = 512;

  // An arm of a union that lies wholly inside another arm.
  struct Redundancy {
    NodeId arm, within;
  };
  std::vector<Redundancy> hidden_arms(const Graph& graph, std::span<const NodeId> arms);

  // Returns the operands of a subtraction, after the first, that do not reach the box of the first.
  std::vector<NodeId> idle_cuts(const Graph& graph, std::span<const NodeId> operands);

  // Returns an intersection's operands without those that contain the whole box of the others and so cut nothing off.
  std::vector<NodeId> without_idle_limits(const Graph& graph, std::span<const NodeId> operands);

  // True if the solid's inside contains the whole box. False if one interval evaluation cannot prove so.
  bool holds(const Graph& graph, NodeId solid, const Box& box);
  // True if the solid avoids the whole box. False if one interval evaluation cannot prove so.
  bool avoids(const Graph& graph, NodeId solid, const Box& box);

  const NodeFacts& known(const Graph& graph, NodeId id);

 private:
  std::optional<vm::Range> range(const Graph& graph, NodeId solid, const Box& box);

  std::vector<NodeFacts> known_;  // [node]
  std::unordered_map<NodeId, std::optional<vm::VerifiedProgram>> programs_;
  vm::Workspace workspace_;
};

}  // namespace fathom::compiler
