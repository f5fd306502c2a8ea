// The functions of formulas in double: what a scene's numbers are evaluated with.
// Tested by: tests/compiler/frontend/formula/formula_test.cpp
#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "compiler/frontend/formula/formula.h"

namespace fathom::compiler {

// Every function that call_function() knows, operators too.
std::span<const FunctionSpec> constant_functions();

// nullopt when there is no function of this name with this many arguments.
std::optional<double> call_function(std::string_view function, std::span<const double> arguments);

// The value of a formula that has no x, y and z in it.
double evaluate(const Formula& formula);

}  // namespace fathom::compiler
