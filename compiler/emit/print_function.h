// Recorded functions as text: nested expressions where a value is used once, named values elsewhere, a loop as a
// loop.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "compiler/emit/language.h"

namespace fathom::compiler {

// The lines between a function's braces, each ended and indented by `indent`; what it returns, too. `parameters` are
// the texts of the function's parameters.
std::string print_body(const Language& language, const vm::RecordedFunction& function,
                       std::span<const Expression> parameters, const std::string& indent);

// The function's result as one expression, if it is no more than one operation.
std::optional<Expression> as_expression(const Language& language, const vm::RecordedFunction& function,
                                        std::span<const Expression> parameters);

// The operations in it that call functions printed beside it, each once.
std::vector<vm::Operation> called_functions(const Language& language, const vm::RecordedFunction& function);

}  // namespace fathom::compiler
