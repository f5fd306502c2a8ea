// Evaluation of formulas in double precision, for the numbers of a scene.
// Tested by: tests/compiler/frontend/formula/formula_test.cpp
#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "compiler/frontend/formula/formula.h"

namespace fathom::compiler {

// Returns every function that call_function() knows, including the operators.
std::span<const FunctionSpec> constant_functions();

// Returns nullopt if no function has this name and this number of arguments.
std::optional<double> call_function(std::string_view function, std::span<const double> arguments);

// Returns the value of a formula without x, y and z.
double evaluate(const Formula& formula);

}  // namespace fathom::compiler
