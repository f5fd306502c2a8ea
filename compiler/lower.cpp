#include "compiler/lower.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <numeric>
#include <tuple>
#include <unordered_map>

#include "compiler/shapes/node_table.h"

namespace fathom::compiler {
namespace {

using vm::Opcode;

// Where a value is wanted: a node at one of the points. Points are numbered; 0 is the caller's.
struct Use {
  NodeId node;
  std::uint32_t point;
  bool operator==(const Use&) const = default;
};
struct UseHash {
  std::size_t operator()(Use use) const {
    return std::hash<std::uint64_t>()(std::uint64_t{use.point} << 32 | use.node);
  }
};

// What is known of a value before code is made for it.
struct Plan {
  std::uint32_t uses = 0;
  std::uint32_t height = 1;  // value slots its evaluation needs, fused
  std::optional<std::uint32_t> local;
};

class Lowering {
 public:
  Lowering(const Graph& graph, const Source& source, std::size_t max_instructions)
      : graph_(graph), source_(source), max_instructions_(max_instructions) {}

  std::optional<vm::Program> run(NodeId root) {
    plan({root, 0});
    if (plans_.size() > max_instructions_) return std::nullopt;
    program_.source_name = source_.name();
    emit({root, 0});
    if (program_.debug.size() > max_instructions_) return std::nullopt;
    return std::move(program_);
  }

 private:
  // Counts uses and computes heights, operands before operators; stops early when there are too many. The DAG may be
  // as deep as it has nodes, so neither this nor emit() recurses.
  void plan(Use root) {
    struct Visit {
      Use use;
      Code code;
      std::vector<Use> operands;
      std::size_t next = 0;
    };
    std::vector<Visit> path;
    const auto enter = [&](Use use) {
      const auto [entry, fresh] = plans_.try_emplace(use);
      ++entry->second.uses;
      if (!fresh) return;
      Code code = this->code(use.node);
      std::vector<Use> operands = this->operands(use, code);
      path.push_back({use, std::move(code), std::move(operands)});
    };
    enter(root);
    while (!path.empty() && plans_.size() <= max_instructions_) {
      Visit& visit = path.back();
      if (visit.next < visit.operands.size()) {
        const Use operand = visit.operands[visit.next++];
        enter(operand);
      } else {
        plans_[visit.use].height = is_free(visit.use.node, visit.code) ? 0 : height(visit.code, visit.operands);
        path.pop_back();
      }
    }
  }

  // A coordinate or a constant is as near as a local that holds it, and can be an operand (compiler/fuse.h).
  bool is_free(NodeId node, const Code& code) const {
    return graph_.children(node).empty() && code.after.size() == 1 && vm::info(code.after[0].opcode).cost == 0;
  }

  Code code(NodeId node) const { return spec(graph_.kind(node)).code(graph_.params(node)); }

  std::uint32_t height(const Code& code, const std::vector<Use>& operands) const {
    const std::vector<std::size_t> order = evaluation_order(code, operands);
    std::uint32_t result = 1;
    for (std::size_t i = 0; i < order.size(); ++i) {
      // After the first, a fold holds one value while it evaluates the next.
      result = std::max(result, plans_.at(operands[order[i]]).height + (i == 0 ? 0 : 1));
    }
    // What follows may push one value of its own.
    const bool pushes = std::any_of(code.after.begin(), code.after.end(),
                                    [](const Instruction& i) { return vm::info(i.opcode).effect.values_change > 0; });
    return std::max(result, pushes && !operands.empty() ? 2u : 1u);
  }

  // A combinator's children at the caller's point; an only child at each of the node's points.
  std::vector<Use> operands(Use use, const Code& code) {
    const std::span<const NodeId> children = graph_.children(use.node);
    std::vector<Use> result;
    if (children.size() == 1) {
      for (const std::vector<Instruction>& chain : code.points)
        result.push_back({children[0], mapped(use.point, chain)});
    } else {
      for (NodeId child : children) result.push_back({child, use.point});
    }
    return result;
  }

  // The number of the point that a chain of instructions makes of `point`.
  std::uint32_t mapped(std::uint32_t point, const std::vector<Instruction>& chain) {
    for (const Instruction& instruction : chain) {
      const auto next = static_cast<std::uint32_t>(points_.size() + 1);
      point = points_.try_emplace({point, instruction.opcode, instruction.immediates}, next).first->second;
    }
    return point;
  }

  // Which operand goes first. The one that needs most stack first keeps the stack low (Sethi & Ullman, "The
  // generation of optimal code for arithmetic expressions", 1970); what folds from the left keeps its order but for
  // the first two.
  std::vector<std::size_t> evaluation_order(const Code& code, const std::vector<Use>& operands) const {
    std::vector<std::size_t> order(operands.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto higher = [&](std::size_t a, std::size_t b) {
      return plans_.at(operands[a]).height > plans_.at(operands[b]).height;
    };
    if (code.any_order) {
      std::stable_sort(order.begin(), order.end(), higher);
    } else if (order.size() > 1 && !code.swapped_join.empty() && higher(1, 0)) {
      std::swap(order[0], order[1]);
    }
    return order;
  }

  // What is still to be done, in the order of a stack: evaluate `use`; append `instructions` for its node; or
  // remember its value in a local.
  enum class Step { Visit, Append, Share };
  struct Task {
    Use use;
    Step step = Step::Visit;
    std::vector<Instruction> instructions = {};
  };

  void emit(Use root) {
    tasks_.push_back({root});
    while (!tasks_.empty() && program_.debug.size() <= max_instructions_) {
      Task task = std::move(tasks_.back());
      tasks_.pop_back();
      if (task.step == Step::Visit) {
        visit(task.use);
      } else if (task.step == Step::Append) {
        for (const Instruction& instruction : task.instructions) append(task.use.node, instruction);
      } else {
        Plan& plan = plans_.at(task.use);
        plan.local = program_.locals++;
        append(task.use.node, {Opcode::Tee, {}, *plan.local});
      }
    }
  }

  void visit(Use use) {
    const Plan& plan = plans_.at(use);
    if (plan.local) return append(use.node, {Opcode::Load, {}, *plan.local});
    const Code code = this->code(use.node);
    std::vector<Task> steps;
    if (graph_.children(use.node).size() > 1) {
      steps = combine(use, code);
    } else {
      steps = alter(use, code);
    }
    if (plan.uses > 1 && !is_free(use.node, code)) steps.push_back({use, Step::Share});
    tasks_.insert(tasks_.end(), std::make_move_iterator(steps.rbegin()), std::make_move_iterator(steps.rend()));
  }

  std::vector<Task> alter(Use use, const Code& code) {
    const std::vector<Use> all = operands(use, code);
    std::vector<Task> steps;
    for (std::size_t i = 0; i < all.size(); ++i) {
      const std::vector<Instruction>& chain = code.points[i];
      steps.push_back({use, Step::Append, chain});
      steps.push_back({all[i]});
      steps.push_back({use, Step::Append, std::vector<Instruction>(chain.size(), {Opcode::Drop})});
      if (i > 0) steps.push_back({use, Step::Append, {{Opcode::Min}}});
    }
    // A combinator of one is that one.
    if (spec(graph_.kind(use.node)).category != Category::Combinator)
      steps.push_back({use, Step::Append, code.after});
    return steps;
  }

  std::vector<Task> combine(Use use, const Code& code) {
    const std::vector<Use> all = operands(use, code);
    const std::vector<std::size_t> order = evaluation_order(code, all);
    const bool swapped = !code.any_order && order[0] == 1;
    std::vector<Task> steps = {{all[order[0]]}};
    if (swapped) steps.push_back({use, Step::Append, code.swapped_first});
    for (std::size_t i = 1; i < order.size(); ++i) {
      steps.push_back({all[order[i]]});
      steps.push_back({use, Step::Append, swapped && i == 1 ? code.swapped_join : code.after});
    }
    return steps;
  }

  void append(NodeId node, const Instruction& instruction) {
    const Origin& origin = graph_.origin(node);
    vm::DebugEntry entry{};
    if (origin.span.end > 0) {
      const Position position = source_.locate(origin.span.begin);
      entry.line = position.line;
      entry.column = position.column;
    }
    entry.symbol = std::string(spec(graph_.kind(node)).name);
    if (!origin.name.empty()) entry.symbol += fmt::format(" \"{}\"", origin.name);
    program_.append(instruction.opcode, instruction.operand, instruction.immediates, std::move(entry));
  }

  const Graph& graph_;
  const Source& source_;
  const std::size_t max_instructions_;
  std::unordered_map<Use, Plan, UseHash> plans_;
  std::vector<Task> tasks_;
  std::map<std::tuple<std::uint32_t, Opcode, std::vector<double>>, std::uint32_t> points_;
  vm::Program program_;
};

}  // namespace

std::optional<vm::Program> lower(const Graph& graph, NodeId root, const Source& source,
                                 std::size_t max_instructions) {
  return Lowering(graph, source, max_instructions).run(root);
}

}  // namespace fathom::compiler
