#include "compiler/frontend/formula/formula_nodes.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <vector>

#include "compiler/geometry/fits_float.h"
#include "compiler/shapes/node_table.h"
#include "vm/program/check.h"

namespace fathom::compiler {

std::span<const FunctionSpec> machine_functions() {
  static constexpr FunctionSpec kAll[] = {
#define FUNCTION(Name, name, form, ...) {name, vm::operand_count(vm::Form::form)},
#define FUNCTION_OF(Name, name, form, ...) {name, vm::operand_count(vm::Form::form)},
#include "vm/program/functions.def"
  };
  return kAll;
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
    const SourceLocation origin{node.span, name};
    if (node.function == "const") {
      made.push_back(graph.add(Kind::Constant, std::array<double, 1>{node.value}, {}, origin));
      continue;
    }
    const NodeSpec* row = find_function(node.function);
    CHECK(row != nullptr, "formulas are of the machine's functions");
    operands.clear();
    for (const std::uint32_t argument : node.arguments) operands.push_back(made[argument]);
    // a * a is a^2, of whose range and slope more is known than of those of a product.
    Kind kind = row->kind;
    if (kind == Kind::Multiply && operands[0] == operands[1]) kind = Kind::Square, operands.pop_back();
    made.push_back(graph.add(kind, {}, operands, origin));
  }
  return made.back();
}

}  // namespace fathom::compiler
