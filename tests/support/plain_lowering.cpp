#include "tests/support/plain_lowering.h"

#include <map>
#include <string>
#include <tuple>
#include <utility>
#include <variant>

#include "compiler/shapes/node_table.h"
#include "tests/support/random/random_scene.h"
#include "vm/program/check.h"

namespace fathom::test {
namespace {

using compiler::Graph;
using compiler::Kind;
using compiler::NodeId;
using vm::Opcode;

class Lowering {
 public:
  explicit Lowering(const Graph& graph) : graph_(graph), uses_(graph.size(), 0) {
    for (NodeId id = 0; id < graph.size(); ++id) {
      for (NodeId child : graph.children(id)) ++uses_[child];
      if (graph.kind(id) == Kind::Paint) painted_ = true;
    }
  }

  // Emits code that leaves one value on the stack: `node`, evaluated at the top point. `frame` numbers that point in
  // the order in which points were pushed.
  void emit(NodeId node, std::uint32_t frame, std::uint32_t paint) {
    if (graph_.kind(node) == Kind::Paint) {
      return emit(graph_.children(node)[0], frame, static_cast<std::uint32_t>(graph_.params(node)[0]));
    }
    const auto [known, is_new] = locals_.try_emplace({node, frame, paint}, program_.locals);
    if (!is_new) return append(Opcode::Load, {}, known->second);
    const bool shared = uses_[node] > 1;
    const std::uint32_t local = known->second;
    if (shared) {
      ++program_.locals;
    } else {
      locals_.erase(known);
    }
    emit_node(node, frame, paint);
    if (shared) append(Opcode::Tee, {}, local);
  }

  vm::Program take() { return std::move(program_); }

 private:
  void append(Opcode opcode, const std::vector<double>& immediates = {}, std::uint32_t operand = 0) {
    program_.append(opcode, operand, immediates, {});
  }
  void append(const std::vector<compiler::Instruction>& instructions) {
    for (const compiler::Instruction& i : instructions) append(i.opcode, i.immediates, i.operand);
  }

  void emit_node(NodeId node, std::uint32_t frame, std::uint32_t paint) {
    const compiler::Code code = compiler::spec(graph_.kind(node)).code(graph_.params(node));
    const auto children = graph_.children(node);
    if (children.empty()) {
      append(code.after);
      if (painted_) append(Opcode::Tag, {}, paint);
    } else if (children.size() == 1) {
      alter(node, code, frame, paint);
    } else {
      emit(children[0], frame, paint);
      for (std::size_t i = 1; i < children.size(); ++i) {
        emit(children[i], frame, paint);
        if (!code.all_at_once || i + 1 == children.size()) append(code.after);
      }
    }
  }

  void alter(NodeId node, const compiler::Code& code, std::uint32_t frame, std::uint32_t paint) {
    bool first = true;
    for (const auto& chain : code.points) {
      append(chain);
      emit(graph_.children(node)[0], chain.empty() ? frame : ++frames_, paint);
      for (std::size_t i = 0; i < chain.size(); ++i) append(Opcode::Drop);
      if (!std::exchange(first, false)) append(Opcode::Min);
    }
    if (compiler::spec(graph_.kind(node)).category == compiler::Category::Combinator) return;
    append(code.after);
    // A distance that the node itself computes (e.g. a repetition's lower bound for omitted copies) belongs to the
    // surface of the node's paint.
    if (painted_ && !code.after.empty()) append(Opcode::Tag, {}, paint);
  }

  const Graph& graph_;
  std::vector<int> uses_;
  bool painted_ = false;
  vm::Program program_;
  std::uint32_t frames_ = 0;
  std::map<std::tuple<NodeId, std::uint32_t, std::uint32_t>, std::uint32_t> locals_;
};

}  // namespace

vm::VerifiedProgram verified(vm::Program program) {
  auto result = vm::verify(std::move(program));
  if (const auto* error = std::get_if<vm::VerifyError>(&result)) CHECK(false, error->reason.c_str());
  return std::get<vm::VerifiedProgram>(std::move(result));
}

vm::VerifiedProgram plain_lowering(const compiler::Scene& scene) {
  Lowering lowering(scene.graph);
  lowering.emit(scene.root, 0, 0);
  return verified(lowering.take());
}

vm::VerifiedProgram primitive_program(Kind kind, const std::vector<double>& params) {
  return plain_lowering(single(kind, params));
}

}  // namespace fathom::test
