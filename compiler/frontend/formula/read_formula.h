// Arithmetic written in strings, such as "sqrt(x^2 + z^2) - r*(1 + 0.1*sin(8*atan2(z, x)))", as a list of operations.
//
//     expression = term {("+" | "-") term}
//     term       = factor {("*" | "/") factor}
//     factor     = "-" factor | primary ["^" factor]       -x^2 is -(x^2), 2^3^2 is 2^9, 2^-x is fine
//     primary    = number | name | name "(" expression {"," expression} ")" | "(" expression ")"
//
// Names are x, y and z where there is a point, the constants pi, e and tau, the scene's parameters, and definitions:
// a formula may be a list of lines, each but the last `name = expression`. Parameters become constants, operations on
// constants are done at once, and whole powers become squares and products. Angles are in radians.
// Tested by: tests/compiler/frontend/formula/formula_test.cpp, formula_errors_test.cpp, tests/golden/diagnostics (E04xx)
#pragma once

#include <optional>
#include <span>

#include "compiler/frontend/formula/formula.h"
#include "compiler/frontend/syntax/scope.h"
#include "compiler/frontend/syntax/syntax.h"
#include "compiler/source/diagnostics.h"

namespace fathom::compiler {

// The formula in a string or a list of strings, with x, y and z; `functions` are those of the machine, which must
// know the operators too. nullopt after reporting what is wrong, or when it uses a parameter about which that was
// done.
std::optional<Formula> read_formula(const syntax::Value& value, const Scope& scope,
                                    std::span<const FunctionSpec> functions, Diagnostics& diagnostics);

// The value of a formula in a string, without x, y and z; nullopt as above. It may be infinite or not a number.
// `may_vary`: whether a formula with x, y and z could stand in its place, which messages then say.
std::optional<double> read_number(const syntax::Value& value, const Scope& scope, Diagnostics& diagnostics,
                                  bool may_vary = false);

}  // namespace fathom::compiler
