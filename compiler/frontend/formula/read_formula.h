// Parser for arithmetic in strings, such as "sqrt(x^2 + z^2) - r*(1 + 0.1*sin(8*atan2(z, x)))". The result is a list
// of operations.
//
//     expression = term {("+" | "-") term}
//     term       = factor {("*" | "/") factor}
//     factor     = "-" factor | primary ["^" factor]       -x^2 is -(x^2), 2^3^2 is 2^9, 2^-x is fine
//     primary    = number | name | name "(" expression {"," expression} ")" | "(" expression ")"
//
// Names are x, y and z where a point is defined, the constants pi, e and tau, the scene's parameters, and
// definitions. A formula may be a list of lines, where every line except the last is `name = expression`. The parser
// replaces parameters by constants, folds operations on constants, and expands whole powers to squares and products.
// Angles are in radians.
// Tested by: tests/compiler/frontend/formula/formula_test.cpp, formula_errors_test.cpp, tests/golden/diagnostics (E04xx)
#pragma once

#include <optional>
#include <span>

#include "compiler/frontend/formula/formula.h"
#include "compiler/frontend/syntax/scope.h"
#include "compiler/frontend/syntax/syntax.h"
#include "compiler/source/diagnostics.h"

namespace fathom::compiler {

// Reads the formula in a string or a list of strings, which may use x, y and z. `functions` are the machine's
// functions, including the operators. Returns nullopt after a report, or if the formula uses a parameter whose error
// is already reported.
std::optional<Formula> read_formula(const syntax::Value& value, const Scope& scope,
                                    std::span<const FunctionSpec> functions, Diagnostics& diagnostics);

// Returns the value of a formula in a string, without x, y and z, or nullopt as above. The value may be infinite or
// NaN. If `may_vary`, a formula with x, y and z would be allowed in this place, and the messages say so.
std::optional<double> read_number(const syntax::Value& value, const Scope& scope, Diagnostics& diagnostics,
                                  bool may_vary = false);

}  // namespace fathom::compiler
