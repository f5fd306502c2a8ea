// Functions that formulas can call: the machine's functions under their names in formulas, and functions composed of
// them.
// Tested by: tests/compiler/frontend/formula/formula_test.cpp
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/frontend/formula/formula_builder.h"

namespace fathom::compiler {

struct FormulaFunction {
  std::string_view name;    // in formulas
  std::size_t least, most;  // minimum and maximum number of arguments
  std::string_view basic;   // the machine's function; empty for a composed function
  FormulaId (*expand)(const FormulaMaker& make, std::span<const FormulaId> arguments) = nullptr;
  // Nonzero for a function whose last argument is a repeat count: a constant whole number from 1 to `max_times`.
  int max_times = 0;

  // Returns the reason why `last` is not a valid last argument, or "" if `last` is valid. nullopt stands for an
  // argument that varies.
  std::string misfit_of(std::optional<double> last) const;
  // `arguments` must have a length that the function accepts.
  FormulaId call(FormulaBuilder& builder, std::span<const FormulaId> arguments, Span span) const;
};

// Returns the machine's functions first, then the composed functions. A machine function replaces a composed function
// of the same name.
std::vector<FormulaFunction> formula_functions(std::span<const FunctionSpec> machine);

}  // namespace fathom::compiler
