// Makes the nodes of a formula: folds constants, expands whole powers, and drops what the result does not need.
// Tested by: tests/compiler/frontend/formula/formula_test.cpp
#pragma once

#include <optional>
#include <span>

#include "compiler/frontend/formula/formula.h"

namespace fathom::compiler {

using FormulaId = std::uint32_t;  // of a node, in its builder

class FormulaBuilder {
 public:
  FormulaId constant(double value, Span span);
  FormulaId coordinate(char axis, Span span);  // 'x', 'y' or 'z'

  // A constant when all arguments are and the function is known in double.
  FormulaId call(std::string_view function, std::span<const FormulaId> arguments, Span span);

  // Whole exponents up to 64 in size become squares and products, 0.5 a root, negative ones their reciprocals.
  FormulaId power(FormulaId base, FormulaId exponent, Span span);

  std::size_t size() const { return nodes_.size(); }
  Span span(FormulaId node) const { return nodes_[node].span; }
  std::optional<double> value(FormulaId node) const;  // of a constant

  // The formula whose result is `root`.
  Formula finish(FormulaId root) const;

 private:
  FormulaId whole_power(FormulaId base, unsigned exponent, Span span);

  std::vector<Formula::Node> nodes_;
};

// Calls with the span of one place in the text: `make("add", {a, b})`.
struct FormulaMaker {
  FormulaBuilder& builder;
  Span span;

  FormulaId operator()(double constant) const { return builder.constant(constant, span); }
  FormulaId operator()(std::string_view function, std::initializer_list<FormulaId> arguments) const {
    return builder.call(function, {arguments.begin(), arguments.size()}, span);
  }
};

}  // namespace fathom::compiler
