#include "compiler/lower/lower.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <tuple>
#include <unordered_map>
#include <utility>
#include <vector>

#include "compiler/shapes/node_table.h"

namespace fathom::compiler {
namespace {

using vm::Opcode;

// A node's value at one of the points. Points are numbered, and number 0 is the caller's point.
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

// A value of the future program, with the facts that are known before its code is emitted.
struct LoweredValue {
  Use use;
  std::uint32_t uses = 0;
  // stack slots for values that the evaluation needs after fusion
  std::uint32_t height = 1;
  std::uint32_t first_operand = 0, operand_count = kNew;  // range of Lowering::operands_
  std::optional<std::uint32_t> local = std::nullopt;

  static constexpr std::uint32_t kNew = 0xffffffff;  // the operands are not listed yet
};
using ValueId = std::uint32_t;

// Code of the nodes of one lowering. Nodes of a kind without parameters share their code, e.g. the functions of
// formulas, of which a scene can have thousands.
class Codes {
 public:
  explicit Codes(const Graph& graph) : graph_(graph), shared_(kKindCount) {}

  std::shared_ptr<const Code> operator()(NodeId node) {
    const Kind kind = graph_.kind(node);
    if (!graph_.params(node).empty()) return make(kind, graph_.params(node));
    std::shared_ptr<const Code>& shared = shared_[static_cast<std::size_t>(kind)];
    if (!shared) shared = make(kind, {});
    return shared;
  }

 private:
  static std::shared_ptr<const Code> make(Kind kind, Params params) {
    return std::make_shared<const Code>(spec(kind).code(params));
  }

  const Graph& graph_;
  std::vector<std::shared_ptr<const Code>> shared_;  // [kind]
};

// True if a program has more than `most` values, which are pairs of a node and a point. A hash of the instructions
// that made a point identifies the point, which takes a tenth of the time and of the memory that Lowering takes. A
// text of a few lines can ask for any number of values.
class ValueCounter {
 public:
  ValueCounter(const Graph& graph, std::size_t most) : graph_(graph), most_(most) {}

  bool more(NodeId root) {
    add(root, 0);
    while (!pending_.empty() && count_ <= most_) {
      const auto [node, point] = pending_.back();
      pending_.pop_back();
      const std::span<const NodeId> children = graph_.children(node);
      if (children.size() == 1) {
        for (const std::vector<std::uint64_t>& chain : chains_of(node)) {
          std::uint64_t moved = point;
          for (const std::uint64_t instruction : chain) moved = mixed(moved, instruction);
          add(children[0], moved);
        }
      } else {
        for (const NodeId child : children) add(child, point);
      }
    }
    return count_ > most_;
  }

 private:
  using Chains = std::vector<std::vector<std::uint64_t>>;  // hashes of instructions

  static std::uint64_t mixed(std::uint64_t hash, std::uint64_t word) {
    const std::uint64_t z = (std::rotl(hash, 23) ^ word) * 0x9E3779B97F4A7C15u;
    return z ^ (z >> 29);
  }

  const Chains& chains_of(NodeId node) {
    std::unique_ptr<Chains>& chains = chains_[node];
    if (chains) return *chains;
    chains = std::make_unique<Chains>();
    for (const auto& points : spec(graph_.kind(node)).code(graph_.params(node)).points) {
      std::vector<std::uint64_t>& chain = chains->emplace_back();
      for (const Instruction& instruction : points) {
        std::uint64_t hash = static_cast<std::uint64_t>(instruction.opcode) + 1;
        for (const double number : instruction.immediates) hash = mixed(hash, std::bit_cast<std::uint64_t>(number));
        chain.push_back(hash);
      }
    }
    return *chains;
  }

  void add(NodeId node, std::uint64_t point) {
    if (table_.size() < 2 * (count_ + 1)) grow();
    if (!insert(mixed(point, node) | 1)) return;
    ++count_;
    pending_.push_back({node, point});
  }
  bool insert(std::uint64_t key) {
    std::size_t place = key >> 20 & (table_.size() - 1);
    for (; table_[place] != 0; place = (place + 1) & (table_.size() - 1)) {
      if (table_[place] == key) return false;
    }
    table_[place] = key;
    return true;
  }
  void grow() {
    std::vector<std::uint64_t> before(std::max<std::size_t>(64, 2 * table_.size()));
    before.swap(table_);
    for (const std::uint64_t key : before) {
      if (key != 0) insert(key);
    }
  }

  const Graph& graph_;
  const std::size_t most_;
  std::size_t count_ = 0;
  std::unordered_map<NodeId, std::unique_ptr<Chains>> chains_;  // of nodes with one child, made on demand
  std::vector<std::pair<NodeId, std::uint64_t>> pending_;
  std::vector<std::uint64_t> table_;  // hashes of the values so far; 0 marks a free entry
};

class Lowering {
 public:
  Lowering(const Graph& graph, const Source& source, std::size_t max_instructions)
      : graph_(graph), source_(source), max_instructions_(max_instructions), codes_(graph) {}

  std::optional<vm::Program> run(NodeId root) {
    const ValueId value = value_of({root, 0});
    plan(value);
    if (values_.size() > max_instructions_) return std::nullopt;
    program_.source_name = source_.name();
    emit(value);
    if (program_.debug.size() > max_instructions_) return std::nullopt;
    return std::move(program_);
  }

 private:
  // Counts uses and computes heights, operands before operators. Stops early if there are too many values. The DAG
  // may be as deep as its number of nodes, so neither plan() nor emit() recurses.
  void plan(ValueId root) {
    struct PlanStep {
      ValueId value;
      std::shared_ptr<const Code> code;
      std::uint32_t next = 0;
    };
    std::vector<PlanStep> path;
    const auto enter = [&](ValueId id) {
      ++values_[id].uses;
      if (values_[id].operand_count != LoweredValue::kNew) return;
      path.push_back({id, codes_(values_[id].use.node)});
      list_operands(id, *path.back().code);
    };
    enter(root);
    while (!path.empty() && values_.size() <= max_instructions_) {
      PlanStep& visit = path.back();
      const std::span<const ValueId> operands = operands_of(visit.value);
      if (visit.next < operands.size()) {
        enter(operands[visit.next++]);
      } else {
        LoweredValue& value = values_[visit.value];
        value.height = is_free(value.use.node, *visit.code) ? 0 : height(*visit.code, operands);
        path.pop_back();
      }
    }
  }

  // True for a coordinate or a constant, which is as cheap as a local and can be an operand (compiler/lower/fuse.h).
  bool is_free(NodeId node, const Code& code) const {
    return graph_.children(node).empty() && code.after.size() == 1 && vm::info(code.after[0].opcode).cost == 0;
  }

  std::uint32_t height(const Code& code, std::span<const ValueId> operands) {
    order_evaluation(code, operands);
    std::uint32_t result = 1;
    for (std::size_t i = 0; i < order_.size(); ++i) {
      // After its first operand, a fold holds one value while it evaluates the next.
      const auto held = static_cast<std::uint32_t>(code.all_at_once ? i : std::min<std::size_t>(i, 1));
      result = std::max(result, values_[order_[i]].height + held);
    }
    // The instructions after the operands may push one value.
    const bool pushes = std::any_of(code.after.begin(), code.after.end(),
                                    [](const Instruction& i) { return vm::info(i.opcode).effect.values_change > 0; });
    return std::max(result, pushes && !operands.empty() ? 2u : 1u);
  }

  ValueId value_of(Use use) {
    const auto [entry, fresh] = ids_.try_emplace(use, static_cast<ValueId>(values_.size()));
    if (fresh) values_.push_back({use});
    return entry->second;
  }

  // Lists a combinator's children at the caller's point, or an only child at each of the node's points.
  void list_operands(ValueId id, const Code& code) {
    const Use use = values_[id].use;
    const auto first = static_cast<std::uint32_t>(operands_.size());
    const std::span<const NodeId> children = graph_.children(use.node);
    if (children.size() == 1) {
      for (const std::vector<Instruction>& chain : code.points) {
        operands_.push_back(value_of({children[0], mapped(use.point, chain)}));
      }
    } else {
      for (const NodeId child : children) operands_.push_back(value_of({child, use.point}));
    }
    values_[id].first_operand = first;
    values_[id].operand_count = static_cast<std::uint32_t>(operands_.size()) - first;
  }
  std::span<const ValueId> operands_of(ValueId id) const {
    return std::span(operands_).subspan(values_[id].first_operand, values_[id].operand_count);
  }

  // Returns the number of the point that a chain of instructions makes of `point`.
  std::uint32_t mapped(std::uint32_t point, const std::vector<Instruction>& chain) {
    for (const Instruction& instruction : chain) {
      const auto next = static_cast<std::uint32_t>(points_.size() + 1);
      point = points_.try_emplace({point, instruction.opcode, instruction.immediates}, next).first->second;
    }
    return point;
  }

  // Puts the operands into the order of their evaluation. Evaluating the operand with the largest stack first keeps
  // the stack low (Sethi & Ullman, "The generation of optimal code for arithmetic expressions", 1970). A fold from
  // the left keeps its order, except that its first two operands may be swapped. Returns true if they are swapped.
  bool order_evaluation(const Code& code, std::span<const ValueId> operands) {
    order_.assign(operands.begin(), operands.end());
    const auto higher = [&](ValueId a, ValueId b) { return values_[a].height > values_[b].height; };
    if (code.any_order) {
      std::stable_sort(order_.begin(), order_.end(), higher);
      return false;
    }
    const bool swapped = order_.size() > 1 && !code.swapped_join.empty() && higher(order_[1], order_[0]);
    if (swapped) std::swap(order_[0], order_[1]);
    return swapped;
  }

  // Kinds of pending tasks, which form a stack: evaluate the value; append `instructions` of its code; drop the
  // points that these instructions made; take the minimum of two values; store the value in a local.
  enum class Step { PlanStep, Append, Drop, Least, Share };
  struct Task {
    ValueId value;
    Step step = Step::PlanStep;
    std::shared_ptr<const Code> code = nullptr;  // keeps the instructions alive
    const std::vector<Instruction>* instructions = nullptr;
  };

  void emit(ValueId root) {
    tasks_.push_back({root});
    while (!tasks_.empty() && program_.debug.size() <= max_instructions_) {
      const Task task = std::move(tasks_.back());
      tasks_.pop_back();
      perform(task);
    }
  }

  void perform(const Task& task) {
    LoweredValue& value = values_[task.value];
    switch (task.step) {
      case Step::PlanStep:
        return visit(task.value);
      case Step::Append:
        for (const Instruction& instruction : *task.instructions) append(value.use.node, instruction);
        return;
      case Step::Drop:
        for (std::size_t i = 0; i < task.instructions->size(); ++i) append(value.use.node, {Opcode::Drop});
        return;
      case Step::Least:
        return append(value.use.node, {Opcode::Min});
      case Step::Share:
        value.local = program_.locals++;
        return append(value.use.node, {Opcode::Tee, {}, *value.local});
    }
  }

  void visit(ValueId id) {
    const LoweredValue& value = values_[id];
    const NodeId node = value.use.node;
    if (value.local) return append(node, {Opcode::Load, {}, *value.local});
    const std::shared_ptr<const Code> code = codes_(node);
    const auto first = static_cast<std::ptrdiff_t>(tasks_.size());
    if (graph_.children(node).size() > 1) {
      combine(id, code);
    } else {
      alter(id, code);
    }
    if (value.uses > 1 && !is_free(node, *code)) tasks_.push_back({id, Step::Share});
    std::reverse(tasks_.begin() + first, tasks_.end());  // puts the first task on top
  }

  void alter(ValueId id, const std::shared_ptr<const Code>& code) {
    const std::span<const ValueId> all = operands_of(id);
    for (std::size_t i = 0; i < all.size(); ++i) {
      const std::vector<Instruction>& chain = code->points[i];
      if (!chain.empty()) tasks_.push_back({id, Step::Append, code, &chain});
      tasks_.push_back({all[i]});
      if (!chain.empty()) tasks_.push_back({id, Step::Drop, code, &chain});
      if (i > 0) tasks_.push_back({id, Step::Least});
    }
    // A combinator of one operand is that operand.
    const bool combinator = spec(graph_.kind(values_[id].use.node)).category == Category::Combinator;
    if (!combinator) tasks_.push_back({id, Step::Append, code, &code->after});
  }

  void combine(ValueId id, const std::shared_ptr<const Code>& code) {
    const bool swapped = order_evaluation(*code, operands_of(id));
    tasks_.push_back({order_[0]});
    if (swapped) tasks_.push_back({id, Step::Append, code, &code->swapped_first});
    for (std::size_t i = 1; i < order_.size(); ++i) {
      tasks_.push_back({order_[i]});
      if (code->all_at_once && i + 1 < order_.size()) continue;
      tasks_.push_back({id, Step::Append, code, swapped && i == 1 ? &code->swapped_join : &code->after});
    }
  }

  void append(NodeId node, const Instruction& instruction) {
    const SourceLocation& origin = graph_.origin(node);
    vm::DebugEntry entry{};
    if (origin.span.end > 0) {
      const Position position = source_.locate(origin.span.begin);
      entry.line = position.line;
      entry.column = position.column;
    }
    entry.symbol = std::string(spec(graph_.kind(node)).name);
    if (!origin.name.empty()) entry.symbol += fmt::format(" \"{}\"", origin.name);
    entry.symbol += source_.in_import(origin.span.begin);
    program_.append(instruction.opcode, instruction.operand, instruction.immediates, std::move(entry));
  }

  const Graph& graph_;
  const Source& source_;
  const std::size_t max_instructions_;
  Codes codes_;
  std::vector<LoweredValue> values_;
  std::vector<ValueId> operands_;  // of all values
  std::unordered_map<Use, ValueId, UseHash> ids_;
  std::vector<ValueId> order_;  // result of order_evaluation()
  std::vector<Task> tasks_;
  std::map<std::tuple<std::uint32_t, Opcode, std::vector<double>>, std::uint32_t> points_;
  vm::Program program_;
};

}  // namespace

bool is_in_import(const vm::DebugEntry& entry, const Source& source) {
  const auto names = [&](const Import& import) {
    return entry.symbol.ends_with(source.in_import(import.file->base()));
  };
  return std::ranges::any_of(source.imports(), names);
}

bool has_more_values(const Scene& scene, std::size_t most) { return ValueCounter(scene.graph, most).more(scene.root); }

std::optional<vm::Program> lower(const Graph& graph, NodeId root, const Source& source,
                                 std::size_t max_instructions) {
  if (ValueCounter(graph, max_instructions).more(root)) return std::nullopt;
  return Lowering(graph, source, max_instructions).run(root);
}

}  // namespace fathom::compiler
