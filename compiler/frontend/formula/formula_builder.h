// Builder for the nodes of a formula: folds constants, expands whole powers, and drops nodes that the result does not
// use.
// Tested by: tests/compiler/frontend/formula/formula_test.cpp
#pragma once

#include <optional>
#include <span>

#include "compiler/frontend/formula/formula.h"

namespace fathom::compiler {

using FormulaId = std::uint32_t;  // index of a node in its builder

class FormulaBuilder {
 public:
  FormulaId constant(double value, Span span);
  FormulaId coordinate(char axis, Span span);  // 'x', 'y' or 'z'

  // Adds a call, folded to a constant if all arguments are constant and call_function() knows the function.
  FormulaId call(std::string_view function, std::span<const FormulaId> arguments, Span span);

  // Adds a power. Whole exponents up to 64 in magnitude become squares and products, and 0.5 becomes a square
  // root. Negative exponents of these become reciprocals.
  FormulaId power(FormulaId base, FormulaId exponent, Span span);

  std::size_t size() const { return nodes_.size(); }
  Span span(FormulaId node) const { return nodes_[node].span; }
  std::optional<double> value(FormulaId node) const;  // of a constant; otherwise nullopt

  // Returns the formula whose result is `root`.
  Formula finish(FormulaId root) const;

 private:
  FormulaId whole_power(FormulaId base, unsigned exponent, Span span);

  std::vector<Formula::Node> nodes_;
};

// Adds constants and calls that share one source span: `make("add", {a, b})`.
struct FormulaMaker {
  FormulaBuilder& builder;
  Span span;

  FormulaId operator()(double constant) const { return builder.constant(constant, span); }
  FormulaId operator()(std::string_view function, std::initializer_list<FormulaId> arguments) const {
    return builder.call(function, {arguments.begin(), arguments.size()}, span);
  }
};

}  // namespace fathom::compiler
