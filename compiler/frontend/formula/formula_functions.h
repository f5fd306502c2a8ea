// What formulas can call: the machine's functions under the names that formulas give them, and functions that are
// made of others.
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
  std::size_t least, most;  // how many arguments it takes
  std::string_view basic;   // the machine's function; empty for one that is made of others
  FormulaId (*expand)(const FormulaMaker& make, std::span<const FormulaId> arguments) = nullptr;
  // The last argument says how often something is done: a constant whole number from 1 to this. 0: there is none
  // such.
  int most_times = 0;

  // `arguments` are as many as it takes.
  // What is wrong with `last` as the last of them, nullopt being a number that varies; empty when nothing is.
  std::string misfit_of(std::optional<double> last) const;
  FormulaId call(FormulaBuilder& builder, std::span<const FormulaId> arguments, Span span) const;
};

// Those of the machine first; it may have one of the others as its own.
std::vector<FormulaFunction> formula_functions(std::span<const FunctionSpec> machine);

}  // namespace fathom::compiler
