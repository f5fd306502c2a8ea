#include "compiler/frontend/formula/formula_evaluate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "vm/number/real.h"
#include "vm/program/check.h"

namespace fathom::compiler {
namespace {

struct Row {
  std::string_view name;
  std::size_t arity;
  double (*apply)(double a, double b, double c);  // arguments beyond the arity are 0
};

// Functions that platforms round differently use the machine's own implementations (vm::real), so that a file gives
// the same scene on every platform.
constexpr Row kFunctions[] = {
    {"add", 2, [](double a, double b, double) { return a + b; }},
    {"minus", 2, [](double a, double b, double) { return a - b; }},
    {"multiply", 2, [](double a, double b, double) { return a * b; }},
    {"divide", 2, [](double a, double b, double) { return a / b; }},
    {"negate", 1, [](double a, double, double) { return -a; }},
    {"abs", 1, [](double a, double, double) { return std::abs(a); }},
    {"square", 1, [](double a, double, double) { return a * a; }},
    {"sqrt", 1, [](double a, double, double) { return std::sqrt(a); }},
    {"sin", 1, [](double a, double, double) { return vm::real::sin(a); }},
    {"cos", 1, [](double a, double, double) { return vm::real::cos(a); }},
    {"tan", 1, [](double a, double, double) { return vm::real::tan(a); }},
    {"asin", 1, [](double a, double, double) { return vm::real::asin(a); }},
    {"acos", 1, [](double a, double, double) { return vm::real::acos(a); }},
    {"atan", 1, [](double a, double, double) { return vm::real::atan(a); }},
    {"atan2", 2, [](double a, double b, double) { return vm::real::atan2(a, b); }},
    {"exp", 1, [](double a, double, double) { return vm::real::exp(a); }},
    {"log", 1, [](double a, double, double) { return vm::real::log(a); }},
    {"power", 2, [](double a, double b, double) { return vm::real::pow(a, b); }},
    {"floor", 1, [](double a, double, double) { return std::floor(a); }},
    {"ceil", 1, [](double a, double, double) { return std::ceil(a); }},
    {"nearest", 1, [](double a, double, double) { return std::nearbyint(a); }},  // halves round to even
    {"sign", 1, [](double a, double, double) { return a > 0   ? 1.0
                                                      : a < 0 ? -1.0
                                                              : a; }},
    // NaN if either operand is NaN, so that NaN is not lost.
    {"min", 2, [](double a, double b, double) { return a < b || a != a ? a : b; }},
    {"max", 2, [](double a, double b, double) { return a > b || a != a ? a : b; }},
    {"modulo", 2, [](double a, double b, double) { return a - b * std::floor(a / b); }},
    {"step", 2, [](double edge, double v, double) { return v < edge    ? 0.0
                                                           : v >= edge ? 1.0
                                                                       : v - edge; }},
    {"noise", 3, [](double a, double b, double c) { return vm::real::noise(a, b, c); }},
};

template <std::size_t n>
constexpr std::array<FunctionSpec, n> specs(const Row (&rows)[n]) {
  std::array<FunctionSpec, n> out{};
  for (std::size_t i = 0; i < n; ++i) out[i] = {rows[i].name, static_cast<int>(rows[i].arity)};
  return out;
}

}  // namespace

std::span<const FunctionSpec> constant_functions() {
  static constexpr auto functions = specs(kFunctions);
  return functions;
}

std::optional<double> call_function(std::string_view function, std::span<const double> arguments) {
  for (const Row& row : kFunctions) {
    if (row.name != function || row.arity != arguments.size()) continue;
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
