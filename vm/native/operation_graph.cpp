#include "vm/native/operation_graph.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <tuple>
#include <unordered_map>

#include "vm/record/record.h"

namespace fathom::vm {
namespace {

using Kind = OperationNode::Kind;

bool is_composed(Operation operation) { return info(operation).cpp.front() == '@'; }

// Returns the body of an operation that consists of others.
const RecordedFunction& body_of(Operation operation) {
  thread_local std::map<Operation, RecordedFunction> bodies;
  auto [found, is_new] = bodies.try_emplace(operation);
  if (is_new) found->second = record(operation, false);
  return found->second;
}

// Returns the result of an operation whose result on constants is the processor's own, so that computing it now
// changes no bit.
std::optional<float> fold(Operation operation, float a, float b) {
  switch (operation) {
    case Operation::Add:
      return a + b;
    case Operation::Subtract:
      return a - b;
    case Operation::Multiply:
      return a * b;
    case Operation::Divide:
      return a / b;
    case Operation::Negate:
      return -a;
    case Operation::Abs:
      return std::fabs(a);
    case Operation::Min:
      return a < b ? a : b;
    case Operation::Max:
      return a > b ? a : b;
    case Operation::Sqrt:
      return std::sqrt(a);
    default:
      return std::nullopt;
  }
}

struct KeyHash {
  std::size_t operator()(const std::array<std::uint32_t, 5>& key) const {
    std::uint64_t hash = 0;
    for (const std::uint32_t word : key) {
      hash = (hash ^ word) * 0x9e3779b97f4a7c15ull;
      hash ^= hash >> 29;
    }
    return hash;
  }
};

class Builder {
 public:
  explicit Builder(std::size_t max_nodes) : max_nodes_(max_nodes) {}

  // Appends the function's statements. Returns its results; they mean nothing once failed() is true.
  std::vector<std::uint32_t> append(const RecordedFunction& function, const std::vector<std::uint32_t>& parameters) {
    std::vector<std::uint32_t> of_statement;
    of_statement.reserve(function.statements.size());
    const auto node_of = [&](const Ref& ref) {
      if (ref.kind == Ref::Kind::Statement) return of_statement[ref.index];
      if (ref.kind == Ref::Kind::Parameter) return parameters[ref.index];
      return constant(static_cast<float>(ref.number));
    };
    for (const Statement& statement : function.statements) {
      failed_ |= statement.operation == Operation::Any || graph_.nodes.size() > max_nodes_;
      if (failed_) return {};
      std::vector<std::uint32_t> operands;
      for (std::size_t i = 0; i < statement.count(); ++i) operands.push_back(node_of(statement.operands[i]));
      if (is_composed(statement.operation)) {
        const std::vector<std::uint32_t> results = append(body_of(statement.operation), operands);
        if (failed_) return {};
        of_statement.push_back(results[0]);
      } else {
        of_statement.push_back(apply(statement.operation, operands));
      }
    }
    std::vector<std::uint32_t> results;
    for (const Ref& ref : function.results) results.push_back(node_of(ref));
    return results;
  }

  std::uint32_t input(std::uint32_t axis) { return unique({Kind::Input, {}, {axis}, 0}); }
  bool failed() const { return failed_; }
  OperationGraph take(std::vector<std::uint32_t> results) {
    graph_.results = std::move(results);
    return std::move(graph_);
  }

 private:
  std::uint32_t constant(float value) { return unique({Kind::Constant, {}, {}, value}); }

  std::uint32_t apply(Operation operation, std::vector<std::uint32_t> operands) {
    const auto is_constant = [&](std::size_t i) {
      return i >= operands.size() || node(operands[i]).kind == Kind::Constant;
    };
    const auto value = [&](std::size_t i) { return i < operands.size() ? node(operands[i]).constant : 0; };
    if (operation == Operation::Select) {
      if (const auto chosen = choose(operands)) return *chosen;
    } else if (is_constant(0) && is_constant(1)) {
      if (const auto folded = fold(operation, value(0), value(1))) return constant(*folded);
    }
    if (const auto simpler = simplify(operation, operands)) return *simpler;
    if ((operation == Operation::Add || operation == Operation::Multiply) && operands[0] > operands[1]) {
      std::swap(operands[0], operands[1]);
    }
    OperationNode result{Kind::Operation, operation, {}, 0};
    for (std::size_t i = 0; i < operands.size(); ++i) result.operands[i] = operands[i];
    return unique(result);
  }

  // Returns the operand that a selection always takes.
  std::optional<std::uint32_t> choose(const std::vector<std::uint32_t>& operands) const {
    if (operands[1] == operands[2]) return operands[1];
    const OperationNode& mask = node(operands[0]);
    if (mask.operation != Operation::Less) return std::nullopt;
    const OperationNode &a = node(mask.operands[0]), &b = node(mask.operands[1]);
    if (a.kind != Kind::Constant || b.kind != Kind::Constant) return std::nullopt;
    return operands[a.constant < b.constant ? 1 : 2];
  }

  // Returns a cheaper node with the same bits for every operand, except for the sign and payload of NaNs.
  std::optional<std::uint32_t> simplify(Operation operation, const std::vector<std::uint32_t>& operands) {
    const std::uint32_t a = operands[0], b = operands.size() > 1 ? operands[1] : a;
    switch (operation) {
      case Operation::Add:
        if (is_value(b, -0.0f)) return a;
        if (is_value(a, -0.0f)) return b;
        if (is(b, Operation::Negate)) return apply(Operation::Subtract, {a, node(b).operands[0]});
        if (is(a, Operation::Negate)) return apply(Operation::Subtract, {b, node(a).operands[0]});
        break;
      case Operation::Subtract:
        if (is_value(b, 0.0f)) return a;
        if (is(b, Operation::Negate)) return apply(Operation::Add, {a, node(b).operands[0]});
        break;
      case Operation::Multiply:
        if (is_value(b, 1)) return a;
        if (is_value(a, 1)) return b;
        if (a == b && (is(a, Operation::Abs) || is(a, Operation::Negate))) {
          return apply(Operation::Multiply, {node(a).operands[0], node(a).operands[0]});
        }
        break;
      case Operation::Divide:
        if (const auto inverse = exact_inverse(b)) return apply(Operation::Multiply, {a, constant(*inverse)});
        break;
      case Operation::Negate:
        if (is(a, Operation::Negate)) return node(a).operands[0];
        break;
      case Operation::Abs:
        if (is(a, Operation::Abs)) return a;
        if (is(a, Operation::Negate)) return apply(Operation::Abs, {node(a).operands[0]});
        break;
      default:
        break;
    }
    return std::nullopt;
  }
  const OperationNode& node(std::uint32_t index) const { return graph_.nodes[index]; }
  bool is(std::uint32_t index, Operation operation) const {
    return node(index).kind == Kind::Operation && node(index).operation == operation;
  }
  bool is_value(std::uint32_t index, float value) const {
    return node(index).kind == Kind::Constant &&
           std::bit_cast<std::uint32_t>(node(index).constant) == std::bit_cast<std::uint32_t>(value);
  }
  // Returns 1 / x of a constant x that is a power of two, unless either is subnormal.
  std::optional<float> exact_inverse(std::uint32_t index) const {
    int exponent;
    const float x = node(index).constant;
    if (node(index).kind != Kind::Constant || !std::isnormal(x) || std::fabs(std::frexp(x, &exponent)) != 0.5f) {
      return std::nullopt;
    }
    return std::isnormal(1 / x) ? std::optional(1 / x) : std::nullopt;
  }

  // Returns the node that equals `node`, which is new if there is none.
  std::uint32_t unique(const OperationNode& node) {
    const std::array<std::uint32_t, 5> key = {
        static_cast<std::uint32_t>(node.kind) << 8 | static_cast<std::uint32_t>(node.operation), node.operands[0],
        node.operands[1], node.operands[2], std::bit_cast<std::uint32_t>(node.constant)};
    const auto [found, is_new] = known_.try_emplace(key, static_cast<std::uint32_t>(graph_.nodes.size()));
    if (is_new) graph_.nodes.push_back(node);
    return found->second;
  }

  std::size_t max_nodes_;
  OperationGraph graph_;
  std::unordered_map<std::array<std::uint32_t, 5>, std::uint32_t, KeyHash> known_;
  bool failed_ = false;
};

// Removes nodes that no result depends on.
OperationGraph without_unused(const OperationGraph& graph) {
  std::vector<std::uint8_t> used(graph.nodes.size(), 0);
  for (const std::uint32_t result : graph.results) used[result] = 1;
  for (std::size_t i = graph.nodes.size(); i-- > 0;) {
    for (std::size_t o = 0; used[i] && o < graph.nodes[i].count(); ++o) used[graph.nodes[i].operands[o]] = 1;
  }
  OperationGraph result;
  std::vector<std::uint32_t> moved(graph.nodes.size());
  for (std::size_t i = 0; i < graph.nodes.size(); ++i) {
    if (!used[i]) continue;
    moved[i] = static_cast<std::uint32_t>(result.nodes.size());
    OperationNode node = graph.nodes[i];
    for (std::size_t o = 0; o < node.count(); ++o) node.operands[o] = moved[node.operands[o]];
    result.nodes.push_back(node);
  }
  for (const std::uint32_t node : graph.results) result.results.push_back(moved[node]);
  return result;
}

// Returns the number of the function's parameters, at least the coordinates.
std::uint32_t parameters_of(const RecordedFunction& function) {
  std::uint32_t count = 3;
  const auto see = [&](const Ref& ref) {
    if (ref.kind == Ref::Kind::Parameter) count = std::max(count, ref.index + 1);
  };
  for (const Statement& statement : function.statements) std::ranges::for_each(statement.operands, see);
  std::ranges::for_each(function.results, see);
  return count;
}

}  // namespace

std::optional<OperationGraph> make_operation_graph(const RecordedFunction& function, std::size_t max_nodes) {
  Builder builder(max_nodes);
  std::vector<std::uint32_t> inputs;
  const std::uint32_t count = parameters_of(function);
  for (std::uint32_t i = 0; i < count; ++i) inputs.push_back(builder.input(i));
  std::vector<std::uint32_t> results = builder.append(function, inputs);
  if (builder.failed()) return std::nullopt;
  return without_unused(builder.take(std::move(results)));
}

}  // namespace fathom::vm
