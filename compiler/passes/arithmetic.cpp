#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <variant>

#include "compiler/geometry/fits_float.h"
#include "compiler/graph/rewrite.h"
#include "compiler/passes/passes.h"
#include "compiler/shapes/node_table.h"
#include "vm/interpret/evaluate.h"
#include "vm/program/check.h"
#include "vm/program/verify.h"

namespace fathom::compiler {
namespace {

using Children = std::span<const NodeId>;

// Evaluates a function of constants on the machine itself, so that folding changes no bit.
double evaluate(Kind kind, std::span<const double> operands) {
  vm::Program program;
  for (const double operand : operands) program.append(vm::Opcode::Constant, 0, {operand}, {});
  for (const Instruction& i : spec(kind).code({}).after) program.append(i.opcode, i.operand, i.immediates, {});
  auto verified = vm::verify(std::move(program));
  CHECK(std::holds_alternative<vm::VerifiedProgram>(verified), "a function of constants is a program");
  vm::Workspace workspace;
  return vm::evaluate_distance(std::get<vm::VerifiedProgram>(verified), glm::dvec3(0), workspace);
}

bool is_power_of_two(double value) {
  int exponent;
  return std::abs(std::frexp(value, &exponent)) == 0.5;
}

class Rules {
 public:
  Rules(Graph& graph, const SourceLocation& origin) : graph_(graph), origin_(origin) {}

  // Returns the node that replaces the function, which may be an operand.
  NodeId make(Kind kind, Children operands) {
    std::vector<double> constants;
    for (const NodeId operand : operands) {
      if (const auto value = constant(operand)) constants.push_back(*value);
    }
    if (!operands.empty() && constants.size() == operands.size()) {
      const double value = evaluate(kind, constants);
      // A program cannot contain a constant that is not finite, so the operation stays in the graph.
      if (fits_float(value)) return constant_node(value);
    }
    const std::optional<NodeId> simpler =
        operands.size() == 1 ? unary(kind, operands[0]) : binary(kind, operands[0], operands[1]);
    return simpler ? *simpler : graph_.add(kind, {}, operands, origin_);
  }

 private:
  std::optional<double> constant(NodeId id) const {
    if (graph_.kind(id) != Kind::Constant) return std::nullopt;
    return graph_.params(id)[0];
  }
  bool is(NodeId id, double value) const { return constant(id) == value; }
  NodeId constant_node(double value) { return graph_.add(Kind::Constant, std::array<double, 1>{value}, {}, origin_); }
  NodeId node(Kind kind, std::initializer_list<NodeId> operands) { return make(kind, std::vector<NodeId>(operands)); }
  // Returns the operand of `id` if `id` is of the given kind.
  std::optional<NodeId> under(Kind kind, NodeId id) const {
    if (graph_.kind(id) != kind) return std::nullopt;
    return graph_.children(id)[0];
  }

  std::optional<NodeId> unary(Kind kind, NodeId a) {
    switch (kind) {
      case Kind::Negate:
        if (const auto inner = under(Kind::Negate, a)) return *inner;
        if (graph_.kind(a) == Kind::Minus) return node(Kind::Minus, {graph_.children(a)[1], graph_.children(a)[0]});
        return std::nullopt;
      case Kind::Abs:
        if (graph_.kind(a) == Kind::Abs || graph_.kind(a) == Kind::Square) return a;
        [[fallthrough]];
      case Kind::Square:
        if (const auto inner = under(Kind::Negate, a)) return node(kind, {*inner});
        if (const auto inner = under(Kind::Abs, a)) return node(kind, {*inner});
        return std::nullopt;
      case Kind::Cos:
        if (const auto inner = under(Kind::Negate, a)) return node(kind, {*inner});
        return std::nullopt;
      default:
        return std::nullopt;
    }
  }

  std::optional<NodeId> binary(Kind kind, NodeId a, NodeId b) {
    switch (kind) {
      case Kind::Add:
        if (is(a, 0)) return b;
        if (is(b, 0)) return a;
        if (const auto inner = under(Kind::Negate, b)) return node(Kind::Minus, {a, *inner});
        if (const auto inner = under(Kind::Negate, a)) return node(Kind::Minus, {b, *inner});
        return std::nullopt;
      case Kind::Minus:
        if (is(b, 0)) return a;
        if (is(a, 0)) return node(Kind::Negate, {b});
        if (const auto inner = under(Kind::Negate, b)) return node(Kind::Add, {a, *inner});
        return std::nullopt;
      case Kind::Multiply:
        if (is(a, 1)) return b;
        if (is(b, 1)) return a;
        if (is(a, -1)) return node(Kind::Negate, {b});
        if (is(b, -1)) return node(Kind::Negate, {a});
        if (a == b) return node(Kind::Square, {a});
        return std::nullopt;
      case Kind::Divide:
        if (is(b, 1)) return a;
        if (const auto divisor = constant(b); divisor && is_power_of_two(*divisor) && fits_float(1 / *divisor))
          return node(Kind::Multiply, {a, constant_node(1 / *divisor)});  // exact: only the exponent changes
        return std::nullopt;
      case Kind::Minimum:
      case Kind::Maximum:
        if (a == b) return a;
        return std::nullopt;
      case Kind::Power:
        if (is(b, 1)) return a;
        if (is(b, 2)) return node(Kind::Square, {a});
        return std::nullopt;
      default:
        return std::nullopt;
    }
  }

  Graph& graph_;
  const SourceLocation& origin_;
};

}  // namespace

Scene arithmetic(const Scene& scene) {
  return rewrite(scene, [&](Graph& out, NodeId id, const std::vector<NodeId>& children) {
    const Kind kind = scene.graph.kind(id);
    const bool function = spec(kind).category == Category::Function && !children.empty();
    if (!function) return keep(scene, out, id, children);
    return Rules(out, scene.graph.origin(id)).make(kind, children);
  });
}

}  // namespace fathom::compiler
