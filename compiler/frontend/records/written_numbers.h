// Formulas in place of a scene file's numbers, and their evaluation.
// Tested by: tests/compiler/frontend/records/scene_numbers_test.cpp, tests/golden/diagnostics (E0101, E0104, E0301)
#pragma once

#include <optional>
#include <string>

#include "compiler/frontend/records/records.h"
#include "compiler/frontend/syntax/scope.h"
#include "compiler/frontend/syntax/syntax.h"
#include "compiler/source/diagnostics.h"

namespace fathom::compiler {

// True if the value contains formulas where the type expects numbers, and otherwise only numbers.
bool has_formulas(const syntax::Value& value, ValueType type);

// True if the value, of a property that may vary over space, does vary: a pattern, or formulas of x, y or z.
bool varies(const syntax::Value& value);

// Replaces the formulas of a value for which has_formulas() is true by numbers. Returns nullopt after a report.
// Evaluates every formula, so that every error is reported. `may_vary` is true if the property may vary over space.
std::optional<syntax::Value> evaluated(const syntax::Value& value, const Scope& scope, Diagnostics& diagnostics,
                                       bool may_vary);

// Returns "; `r - 2` is -1" with the formula in `written` whose value is `part` of evaluated(written). Returns "" if
// that number was not a formula.
std::string explain(const syntax::Value& written, const syntax::Value& part);

}  // namespace fathom::compiler
