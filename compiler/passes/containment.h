// Which operands of hard combinators change nothing, as far as boxes and one look with intervals show: what
// passes/cull.cpp leaves out and compiler/analysis/lints.cpp warns of.
// Tested by: tests/compiler/passes/passes_test.cpp, tests/golden/diagnostics (W0501, W0502, W0503)
#pragma once

#include <cstddef>
#include <optional>
#include <unordered_map>
#include <vector>

#include "compiler/graph/graph.h"
#include "compiler/graph/knowledge.h"
#include "vm/interpret/evaluate.h"

namespace fathom::compiler {

// Of one graph, which may grow between calls.
class Containment {
 public:
  // Pairs of operands are compared in lists up to this long; longer ones are left to the renderer.
  static constexpr std::size_t kLongestList = 512;

  // An arm of a union that lies wholly inside another.
  struct Hidden {
    NodeId arm, within;
  };
  std::vector<Hidden> hidden_arms(const Graph& graph, std::span<const NodeId> arms);

  // Operands of a subtraction, after the first, that do not reach its box.
  std::vector<NodeId> idle_cuts(const Graph& graph, std::span<const NodeId> operands);

  // An intersection's operands without those that hold all the others' box and cut nothing off.
  std::vector<NodeId> without_idle_limits(const Graph& graph, std::span<const NodeId> operands);

  // Whether the solid's inside contains the whole box; false when that is not seen at one look.
  bool holds(const Graph& graph, NodeId solid, const Box& box);
  // Whether the solid keeps out of the whole box; false likewise.
  bool avoids(const Graph& graph, NodeId solid, const Box& box);

  const Knowledge& known(const Graph& graph, NodeId id);

 private:
  std::optional<vm::Range> range(const Graph& graph, NodeId solid, const Box& box);

  std::vector<Knowledge> known_;  // [node]
  std::unordered_map<NodeId, std::optional<vm::VerifiedProgram>> programs_;
  vm::Workspace workspace_;
};

}  // namespace fathom::compiler
