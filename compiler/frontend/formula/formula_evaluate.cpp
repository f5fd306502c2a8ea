#include "compiler/frontend/formula/formula_evaluate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "vm/number/real.h"
#include "vm/program/check.h"
#include "vm/program/opcode.h"

namespace fathom::compiler {
namespace {

namespace real = vm::real;

struct Row {
  FunctionSpec function;
  double (*apply)(double a, double b, double c);  // arguments beyond the arity are 0
};

// The functions that have a value in double.
constexpr Row kFunctions[] = {
#define VALUE(name, form, ...)                           \
  __VA_OPT__({{name, vm::operand_count(vm::Form::form)}, \
              [](double a, [[maybe_unused]] double b, [[maybe_unused]] double c) { return __VA_ARGS__; }}, )
#define FUNCTION(Name, name, form, cost, facts, meaning, doc, ...) VALUE(name, form, __VA_ARGS__)
#define FUNCTION_OF(Name, name, form, opcode, doc, ...) VALUE(name, form, __VA_ARGS__)
#include "vm/program/functions.def"
#undef VALUE
};

template <std::size_t n>
constexpr std::array<FunctionSpec, n> specs(const Row (&rows)[n]) {
  std::array<FunctionSpec, n> out{};
  for (std::size_t i = 0; i < n; ++i) out[i] = rows[i].function;
  return out;
}

}  // namespace

std::span<const FunctionSpec> constant_functions() {
  static constexpr auto functions = specs(kFunctions);
  return functions;
}

std::optional<double> call_function(std::string_view function, std::span<const double> arguments) {
  for (const Row& row : kFunctions) {
    if (row.function.name != function || row.function.arity != static_cast<int>(arguments.size())) continue;
    const auto argument = [&](std::size_t i) { return i < arguments.size() ? arguments[i] : 0; };
    return row.apply(argument(0), argument(1), argument(2));
  }
  return std::nullopt;
}

double evaluate(const Formula& formula) {
  std::vector<double> values, arguments;
  values.reserve(formula.nodes.size());
  for (const Formula::Node& node : formula.nodes) {
    arguments.clear();
    for (const std::uint32_t argument : node.arguments) arguments.push_back(values[argument]);
    const auto value = node.function == "const" ? std::optional(node.value) : call_function(node.function, arguments);
    CHECK(value.has_value(), "a formula without x, y and z, of functions that are known here");
    values.push_back(*value);
  }
  return values.back();
}

}  // namespace fathom::compiler
