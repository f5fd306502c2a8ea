#include "compiler/frontend/formula/formula_builder.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>
#include <unordered_map>
#include <utility>

#include "compiler/frontend/formula/formula_evaluate.h"

namespace fathom::compiler {
namespace {

// A product of 64 factors built from squares rounds 7 times, no more than a power computed with logarithms.
constexpr double kLargestUnrolledPower = 64;

constexpr std::string_view kAxes = "xyz";

}  // namespace

FormulaId FormulaBuilder::constant(double value, Span span) {
  nodes_.push_back({"const", value, {}, span});
  return static_cast<FormulaId>(nodes_.size() - 1);
}

FormulaId FormulaBuilder::coordinate(char axis, Span span) {
  nodes_.push_back({kAxes.substr(kAxes.find(axis), 1), 0, {}, span});
  return static_cast<FormulaId>(nodes_.size() - 1);
}

FormulaId FormulaBuilder::call(std::string_view function, std::span<const FormulaId> arguments, Span span) {
  std::vector<double> values;
  for (const FormulaId argument : arguments) {
    if (const auto known = value(argument)) values.push_back(*known);
  }
  if (values.size() == arguments.size()) {
    if (const auto result = call_function(function, values)) return constant(*result, span);
  }
  nodes_.push_back({function, 0, {arguments.begin(), arguments.end()}, span});
  return static_cast<FormulaId>(nodes_.size() - 1);
}

FormulaId FormulaBuilder::power(FormulaId base, FormulaId exponent, Span span) {
  const FormulaMaker make{*this, span};
  const auto n = value(exponent);
  if (!n) return make("power", {base, exponent});
  const double size = std::abs(*n);
  const bool whole = size <= kLargestUnrolledPower && size == std::floor(size);
  if (!whole && size != 0.5) return make("power", {base, exponent});
  const FormulaId result = whole ? whole_power(base, static_cast<unsigned>(size), span) : make("sqrt", {base});
  return *n < 0 ? make("divide", {make(1.0), result}) : result;
}

// Square-and-multiply from the exponent's highest bit down.
FormulaId FormulaBuilder::whole_power(FormulaId base, unsigned exponent, Span span) {
  const FormulaMaker make{*this, span};
  if (exponent == 0) return make(1.0);
  FormulaId result = base;
  for (unsigned bit = std::bit_floor(exponent) / 2; bit > 0; bit /= 2) {
    result = make("square", {result});
    if (exponent & bit) result = make("multiply", {result, base});
  }
  return result;
}

std::optional<double> FormulaBuilder::value(FormulaId node) const {
  return nodes_[node].function == "const" ? std::optional(nodes_[node].value) : std::nullopt;
}

// Copies nodes depth first, so that equal formulas become equal lists regardless of the order of construction.
Formula FormulaBuilder::finish(FormulaId root) const {
  std::unordered_map<FormulaId, FormulaId> places;
  std::vector<FormulaId> open = {root};
  Formula formula;
  while (!open.empty()) {
    const FormulaId id = open.back();
    const std::vector<FormulaId>& arguments = nodes_[id].arguments;
    const auto waits = [&](FormulaId argument) { return !places.contains(argument); };
    std::copy_if(arguments.rbegin(), arguments.rend(), std::back_inserter(open), waits);
    if (open.back() != id) continue;
    open.pop_back();
    if (!places.emplace(id, static_cast<FormulaId>(formula.nodes.size())).second) continue;
    Formula::Node& copied = formula.nodes.emplace_back(nodes_[id]);
    for (FormulaId& argument : copied.arguments) argument = places[argument];
  }
  return formula;
}

}  // namespace fathom::compiler
