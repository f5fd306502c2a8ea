#include "compiler/derive/derive.h"

#include <fmt/format.h>

#include "compiler/derive/formula_field.h"
#include "compiler/graph/rewrite.h"
#include "compiler/shapes/node_table.h"
#include "vm/program/opcode.h"

namespace fathom::compiler {
namespace {

// Reports a node that evaluates its child too often, or iterates too often.
void check_size(const Graph& graph, NodeId id, Span type_span, const Limits& limits, Diagnostics& diagnostics) {
  const Code code = spec(graph.kind(id)).code(graph.params(id));
  const auto copies = static_cast<double>(code.points.size());
  if (copies > limits.copies) {
    diagnostics.error(
        "E0312", type_span,
        fmt::format("{} copies of the node count at every point; at most {} are evaluated", copies, limits.copies),
        "", {"make `period` larger or the node smaller", raise(&Limits::copies, copies)});
  }
  for (const Instruction& instruction : code.after) {
    const vm::OpcodeInfo& row = vm::info(instruction.opcode);
    for (int i = 0; i < row.immediates; ++i) {
      const double count = instruction.immediates[static_cast<std::size_t>(i)];
      if (!vm::is_integer_immediate(row, i) || count <= limits.iterations) continue;
      diagnostics.error("E0312", type_span,
                        fmt::format("`{}` is {}; at most {} are allowed, for it is a loop at every point",
                                    vm::immediate_name(row, i), count, limits.iterations),
                        "", {raise(&Limits::iterations, count)});
    }
  }
}

class Deriver {
 public:
  Deriver(const Graph& described, Graph& out, std::span<const Span> type_spans, const Limits& limits,
          Diagnostics& diagnostics)
      : described_(described), maker_(out), type_spans_(type_spans), limits_(limits), diagnostics_(diagnostics) {}

  // Returns the node of `out` for node `id` of the described graph. After an error, returns any node to continue
  // with.
  NodeId make(NodeId id, std::span<const NodeId> children) {
    if (full_) return 0;
    const Kind kind = described_.kind(id);
    const std::span<const double> params = described_.params(id);
    const Span type_span = id < type_spans_.size() ? type_spans_[id] : Span{};
    if (const ErrorText problem = maker_.complaint(kind, params, children)) {
      const NodeSpec& row = spec(kind);
      diagnostics_.error("E0302", type_span, *problem, "", {fmt::format("`{}`: {}", row.name, row.doc)});
      return children[0];
    }
    const NodeId made = make_field(maker_, kind, params, children, described_.origin(id), allowance_);
    if (type_span.end > 0) check_size(maker_.graph(), made, type_span, limits_, diagnostics_);
    check_count(described_.origin(id).span);
    return made;
  }

 private:
  void check_count(Span span) {
    const std::optional<Excess> excess = excess_of(static_cast<double>(maker_.graph().size()), limits_);
    if (!excess) return;
    full_ = true;
    diagnostics_.error("E0312", span, excess->what, "", {excess->remedy});
  }

  const Graph& described_;
  NodeMaker maker_;
  SearchAllowance allowance_;
  const std::span<const Span> type_spans_;
  const Limits& limits_;
  Diagnostics& diagnostics_;
  bool full_ = false;  // true after check_count() has reported that the limit of nodes is reached
};

}  // namespace

std::optional<Scene> derive(const Scene& described, std::span<const Span> type_spans, const Limits& limits,
                            Diagnostics& diagnostics) {
  std::optional<Deriver> deriver;
  Scene scene = rewrite(described, [&](Graph& out, NodeId id, const std::vector<NodeId>& children) {
    if (!deriver) deriver.emplace(described.graph, out, type_spans, limits, diagnostics);
    return deriver->make(id, children);
  });
  if (diagnostics.has_errors()) return std::nullopt;
  return scene;
}

}  // namespace fathom::compiler
