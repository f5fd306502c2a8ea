// Result of evaluating a text: one value per statement.
#pragma once

#include <optional>
#include <vector>

#include "compiler/frontend/syntax/scope.h"
#include "compiler/frontend/text/evaluate/value.h"

namespace fathom::compiler::text {

// Values of the statements, and the parameters.
struct Evaluated {
  Store store;
  std::vector<std::optional<Value>> values;  // [statement] nullopt for functions, and after an error
  Scope parameters;
  // With keep_formulas: places where the value of a parameter was needed, such as a condition or a range.
  std::vector<Span> frozen;
};

}  // namespace fathom::compiler::text
