// Formulas that stand where a scene file has numbers, and what they come to.
// Tested by: tests/compiler/frontend/records/scene_numbers_test.cpp, tests/golden/diagnostics (E0101, E0104, E0301)
#pragma once

#include <optional>
#include <string>

#include "compiler/frontend/records/records.h"
#include "compiler/frontend/syntax/scope.h"
#include "compiler/frontend/syntax/syntax.h"
#include "compiler/source/diagnostics.h"

namespace fathom::compiler {

// Whether formulas stand where the type has numbers, and nothing but numbers beside them.
bool has_formulas(const syntax::Value& value, ValueType type);

// Whether the value is a pattern, or has formulas of x, y or z: of a property that may vary over space, that it does.
bool varies(const syntax::Value& value);

// The value, for which has_formulas(), with numbers only; nullopt after a report. Every formula is looked at.
// `may_vary`: whether the property is one that may vary over space.
std::optional<syntax::Value> evaluated(const syntax::Value& value, const Scope& scope, Diagnostics& diagnostics,
                                       bool may_vary);

// "; `r - 2` is -1": the formula in `written` that came to this part of evaluated(written); "" when it was no
// formula.
std::string explain(const syntax::Value& written, const syntax::Value& part);

}  // namespace fathom::compiler
