#include "compiler/frontend/formula/formula_nodes.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <vector>

#include "compiler/geometry/fits_float.h"
#include "compiler/shapes/node_table.h"
#include "vm/program/check.h"

namespace fathom::compiler {
namespace {

int arity(const NodeSpec& row) {
  const std::vector<double> any(row.params.size(), 0.0);
  switch (vm::info(row.code(any).after.back().opcode).form) {
    case vm::Form::Unary:
      return 1;
    case vm::Form::Binary:
      return 2;
    case vm::Form::Ternary:
      return 3;
    default:
      return 0;
  }
}

}  // namespace

std::span<const FunctionSpec> machine_functions() {
  static const std::vector<FunctionSpec> functions = [] {
    std::vector<FunctionSpec> made;
    for (const NodeSpec& row : node_table()) {
      if (row.category != Category::Function) continue;
      if (const int operands = arity(row); operands > 0) made.push_back({row.name, operands});
    }
    return made;
  }();
  return functions;
}

bool holds_in_float(const Formula& formula, Diagnostics& diagnostics) {
  bool all = true;
  for (const Formula::Node& node : formula.nodes) {
    if (node.function != "const" || fits_float(node.value)) continue;
    all = false;
    const bool none = std::isnan(node.value);
    const std::string is = none ? "has no value" : fmt::format("is {}", node.value);
    diagnostics.error("E0409", node.span, fmt::format("this part of the formula {}", is), "",
                      {none ? "it is like 0/0, wherever it is evaluated: write a number"
                            : "numbers are evaluated in float, which ends at 3.4e38: scale the formula down"});
  }
  return all;
}

NodeId make_formula(Graph& graph, const Formula& formula, const std::string& name) {
  std::vector<NodeId> made, operands;
  for (const Formula::Node& node : formula.nodes) {
    const Origin origin{node.span, name};
    if (node.function == "const") {
      made.push_back(graph.add(Kind::Constant, std::array<double, 1>{node.value}, {}, origin));
      continue;
    }
    const NodeSpec* row = find_function(node.function);
    CHECK(row != nullptr, "formulas are of the machine's functions");
    operands.clear();
    for (const std::uint32_t argument : node.arguments) operands.push_back(made[argument]);
    made.push_back(graph.add(row->kind, {}, operands, origin));
  }
  return made.back();
}

}  // namespace fathom::compiler
