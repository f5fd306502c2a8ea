// Prints recorded functions. A value that is used once is nested in the expression that uses it, other values get
// names, and a loop stays a loop.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "compiler/emit/language.h"

namespace fathom::compiler {

// Returns the lines between a function's braces, including the return statement. Each line begins with `indent` and
// ends with a newline. `parameters` are the texts of the function's parameters.
std::string print_body(const Language& language, const vm::RecordedFunction& function,
                       std::span<const Expression> parameters, const std::string& indent);

// Returns the function's result as one expression, if the function has at most one operation.
std::optional<Expression> as_expression(const Language& language, const vm::RecordedFunction& function,
                                        std::span<const Expression> parameters);

// Returns the operations that call functions which the library must print, too, each once.
std::vector<vm::Operation> called_functions(const Language& language, const vm::RecordedFunction& function);

}  // namespace fathom::compiler
