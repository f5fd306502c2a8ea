// The outcome of a text's evaluation: a value per statement.
#pragma once

#include <optional>
#include <vector>

#include "compiler/frontend/syntax/scope.h"
#include "compiler/frontend/text/evaluate/value.h"

namespace fathom::compiler::text {

// Values of the statements.
struct Evaluated {
  Store store;
  std::vector<std::optional<Value>> values;  // [statement] nothing of a function, and after an error
  Scope parameters;
  // With keep_formulas: where a parameter's value was needed to go on, in a condition or a range.
  std::vector<Span> frozen;
};

}  // namespace fathom::compiler::text
