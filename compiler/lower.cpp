#include "compiler/lower.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>

#include "compiler/affine.h"
#include "compiler/shapes/node_table.h"
#include "vm/check.h"

namespace fathom::compiler {
namespace {

using vm::Opcode;

// Where a value is wanted: a node at one of the points. Points are numbered; 0 is the caller's.
struct Use {
  NodeId node;
  std::uint32_t point;
  auto operator<=>(const Use&) const = default;
};

// What is known of a value before code is made for it.
struct Plan {
  std::uint32_t uses = 0;
  std::uint32_t height = 1;  // value slots its evaluation needs
  std::optional<std::uint32_t> local;
};

class Lowering {
 public:
  Lowering(const Scene& scene, const Source& source, std::size_t max_instructions)
      : graph_(scene.graph), source_(source), max_instructions_(max_instructions) {}

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
      std::vector<Use> operands;
      std::size_t next = 0;
    };
    std::vector<Visit> path;
    const auto enter = [&](Use use) {
      const auto [entry, fresh] = plans_.try_emplace(use);
      ++entry->second.uses;
      if (fresh) path.push_back({use, operands(use)});
    };
    enter(root);
    while (!path.empty() && plans_.size() <= max_instructions_) {
      Visit& visit = path.back();
      if (visit.next < visit.operands.size()) {
        const Use operand = visit.operands[visit.next++];
        enter(operand);
      } else {
        plans_[visit.use].height = height(visit.use, visit.operands);
        path.pop_back();
      }
    }
  }

  std::uint32_t height(Use use, const std::vector<Use>& operands) const {
    std::vector<std::uint32_t> heights;
    for (const Use& operand : operands) heights.push_back(plans_.at(operand).height);
    const std::vector<std::size_t> order = evaluation_order(graph_.kind(use.node), heights);
    std::uint32_t result = 1;
    for (std::size_t i = 0; i < order.size(); ++i) {
      // After the first, a fold holds one value while it evaluates the next.
      result = std::max(result, heights[order[i]] + (i == 0 ? 0 : 1));
    }
    return result;
  }

  std::vector<Use> operands(Use use) {
    const std::uint32_t point = graph_.kind(use.node) == Kind::Transform ? transformed(use) : use.point;
    std::vector<Use> result;
    for (NodeId child : graph_.children(use.node)) result.push_back({child, point});
    return result;
  }

  // The number of the point a Transform node makes of `use.point`.
  std::uint32_t transformed(Use use) {
    const auto params = graph_.params(use.node);
    std::vector<double> key(params.begin(), params.begin() + 12);
    return points_.try_emplace({use.point, std::move(key)}, static_cast<std::uint32_t>(points_.size() + 1))
        .first->second;
  }

  // Which operand goes first. The one that needs most stack first keeps the stack low (Sethi & Ullman, "The
  // generation of optimal code for arithmetic expressions", 1970); blends of more than two keep their order.
  static std::vector<std::size_t> evaluation_order(Kind kind, const std::vector<std::uint32_t>& heights) {
    std::vector<std::size_t> order(heights.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto higher = [&](std::size_t a, std::size_t b) { return heights[a] > heights[b]; };
    if (kind == Kind::Union || kind == Kind::Intersection) {
      std::stable_sort(order.begin(), order.end(), higher);
    } else if (order.size() > 1 && higher(1, 0)) {
      std::swap(order[0], order[1]);
    }
    return order;
  }

  // What is still to be done for a value, in the order of a stack.
  enum class Step { Visit, Finish, LeaveTransform, Negate, Combine, CombineNegated, Share };
  struct Task {
    Use use;
    Step step;
  };

  void emit(Use root) {
    tasks_ = {{root, Step::Visit}};
    while (!tasks_.empty() && program_.debug.size() <= max_instructions_) {
      const Task task = tasks_.back();
      tasks_.pop_back();
      perform(task);
    }
  }

  void perform(Task task) {
    const NodeId node = task.use.node;
    switch (task.step) {
      case Step::Visit:
        return visit(task.use);
      case Step::Finish:
        return emit_unary(node);
      case Step::LeaveTransform:
        append(node, Opcode::Drop, 0, {});
        if (const double factor = graph_.params(node)[12]; factor != 1) append(node, Opcode::Scale, 0, {factor});
        return;
      case Step::Negate:
        return append(node, Opcode::Negate, 0, {});
      case Step::Combine:
        return emit_combinator(node, false);
      case Step::CombineNegated:
        return emit_combinator(node, true);
      case Step::Share: {
        Plan& plan = plans_.at(task.use);
        plan.local = program_.locals++;
        return append(node, Opcode::Tee, *plan.local, {});
      }
    }
  }

  void visit(Use use) {
    const Plan& plan = plans_.at(use);
    if (plan.local) return append(use.node, Opcode::Load, *plan.local, {});
    const Kind kind = graph_.kind(use.node);
    std::vector<Task> steps;
    if (const NodeSpec& row = spec(kind); row.opcode) {
      append(use.node, *row.opcode, 0, row.immediates(graph_.params(use.node)));
    } else if (kind == Kind::Transform) {
      enter_transform(use.node);
      steps = {{operands(use)[0], Step::Visit}, {use, Step::LeaveTransform}};
    } else if (graph_.children(use.node).size() == 1) {
      steps = {{operands(use)[0], Step::Visit}, {use, Step::Finish}};
    } else {
      steps = fold_steps(use);
    }
    if (plan.uses > 1) steps.push_back({use, Step::Share});
    tasks_.insert(tasks_.end(), steps.rbegin(), steps.rend());
  }

  void enter_transform(NodeId node) {
    const Affine map = Affine::from_params(graph_.params(node));
    const Affine identity{{glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 1)}, glm::dvec3(0)};
    if (map.rows == identity.rows) {
      append(node, Opcode::Translate, 0, {-map.translation.x, -map.translation.y, -map.translation.z});
    } else {
      const auto twelve = map.params();
      append(node, Opcode::Affine, 0, {twelve.begin(), twelve.end()});
    }
  }

  void emit_unary(NodeId node) {
    const auto params = graph_.params(node);
    switch (graph_.kind(node)) {
      case Kind::Round:
        return append(node, Opcode::Offset, 0, {params[0]});
      case Kind::Onion:
        return append(node, Opcode::Onion, 0, {params[0]});
      case Kind::Paint:
        return append(node, Opcode::Tag, static_cast<std::uint32_t>(params[0]), {});
      default:
        return;  // a combinator of one is that one
    }
  }

  std::vector<Task> fold_steps(Use use) {
    const std::vector<Use> all = operands(use);
    std::vector<std::uint32_t> heights;
    for (const Use& operand : all) heights.push_back(plans_.at(operand).height);
    const std::vector<std::size_t> order = evaluation_order(graph_.kind(use.node), heights);
    const bool cut_first = is_subtraction(use.node) && order[0] == 1;
    std::vector<Task> steps = {{all[order[0]], Step::Visit}};
    if (cut_first) steps.push_back({use, Step::Negate});
    for (std::size_t i = 1; i < order.size(); ++i) {
      steps.push_back({all[order[i]], Step::Visit});
      steps.push_back({use, cut_first && i == 1 ? Step::CombineNegated : Step::Combine});
    }
    return steps;
  }

  bool is_subtraction(NodeId node) const {
    return graph_.kind(node) == Kind::Subtraction || graph_.kind(node) == Kind::SmoothSubtraction;
  }

  // `negated`: the cut lies below, already negated, so that a - b is the maximum of both.
  void emit_combinator(NodeId node, bool negated) {
    const auto params = graph_.params(node);
    const auto blend = [&](Opcode opcode) {
      const double k = params[0];
      // A width of 0 blends nothing; the optimiser makes it the hard operator, unoptimised code must not divide by
      // it.
      append(node, opcode, 0, {k, k > kLeastBlend ? 0.25 / k : 0});
    };
    switch (graph_.kind(node)) {
      case Kind::Union:
        return append(node, Opcode::Min, 0, {});
      case Kind::Intersection:
        return append(node, Opcode::Max, 0, {});
      case Kind::Subtraction:
        return append(node, negated ? Opcode::Max : Opcode::Subtract, 0, {});
      case Kind::SmoothUnion:
        return blend(Opcode::SmoothMin);
      case Kind::SmoothIntersection:
        return blend(Opcode::SmoothMax);
      case Kind::SmoothSubtraction:
        return blend(negated ? Opcode::SmoothMax : Opcode::SmoothSubtract);
      default:
        CHECK(false, "only combinators have several children");
    }
  }

  void append(NodeId node, Opcode opcode, std::uint32_t operand, const std::vector<double>& immediates) {
    const Origin& origin = graph_.origin(node);
    vm::DebugEntry entry{};
    if (origin.span.end > 0) {
      const Position position = source_.locate(origin.span.begin);
      entry.line = position.line;
      entry.column = position.column;
    }
    entry.symbol = std::string(spec(graph_.kind(node)).name);
    if (!origin.name.empty()) entry.symbol += fmt::format(" \"{}\"", origin.name);
    program_.append(opcode, operand, immediates, std::move(entry));
  }

  const Graph& graph_;
  const Source& source_;
  const std::size_t max_instructions_;
  std::map<Use, Plan> plans_;
  std::vector<Task> tasks_;
  std::map<std::pair<std::uint32_t, std::vector<double>>, std::uint32_t> points_;
  vm::Program program_;
};

}  // namespace

std::optional<vm::Program> lower(const Scene& scene, const Source& source, std::size_t max_instructions) {
  return Lowering(scene, source, max_instructions).run(scene.root);
}

}  // namespace fathom::compiler
