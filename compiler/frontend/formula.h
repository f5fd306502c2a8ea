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
// Tested by: tests/compiler/formula_test.cpp, formula_errors_test.cpp, tests/golden/diagnostics (E04xx)
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "compiler/diagnostics.h"
#include "compiler/frontend/scope.h"
#include "compiler/frontend/syntax.h"

namespace fathom::compiler {

struct FormulaFunction;

// A function of the machine.
struct FunctionSpec {
  std::string_view name;
  int arity;
};

// A directed acyclic graph: what is used twice is one node.
struct Formula {
  struct Node {
    // "const", "x", "y", "z", or a function of the machine: "add", "minus", "multiply", "divide", "negate", "square",
    // "power" from operators, the others from calls. Lives as long as the table of functions does.
    std::string_view function;
    double value = 0;  // of a "const"
    std::vector<std::uint32_t> arguments;
    Span span;  // what it was made of
  };
  std::vector<Node> nodes;  // arguments before what they are arguments of; the last is the result
};

// The formula in a string or a list of strings, with x, y and z; `functions` are those of the machine, which must
// know the operators too. nullopt after reporting what is wrong, or when it uses a parameter about which that was
// done.
std::optional<Formula> read_formula(const syntax::Value& value, const Scope& scope,
                                    std::span<const FunctionSpec> functions, Diagnostics& diagnostics);

// The value of a formula in a string, without x, y and z; nullopt as above. It may be infinite or not a number.
// `may_vary`: whether a formula with x, y and z could stand in its place, which messages then say.
std::optional<double> read_number(const syntax::Value& value, const Scope& scope, Diagnostics& diagnostics,
                                  bool may_vary = false);

// The value of a formula that has no x, y and z in it.
double evaluate(const Formula& formula);

// The value of a constant of formulas, such as pi; nullopt when the name is none.
std::optional<double> formula_constant(std::string_view name);

// What is wrong with giving this name to a parameter or a definition where formulas have these functions
// (compiler/frontend/formula_functions.h); empty when nothing is.
std::string misfit_name(std::string_view name, std::span<const FormulaFunction> functions);

}  // namespace fathom::compiler
