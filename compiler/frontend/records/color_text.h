// Colours as strings: "#c04020" or "#c42" give red, green and blue in hexadecimal, sRGB-encoded (IEC 61966-2-1), and
// "tomato" is a colour of CSS, unless a parameter has that name: then the string is a formula. Formulas never begin
// with "#". Scene colours are linear, so the reader decodes a colour string.
// Tested by: tests/compiler/frontend/records/color_text_test.cpp, tests/golden/diagnostics (E0101_color_text, E0104_albedo)
#pragma once

#include <optional>
#include <string>

#include "compiler/frontend/records/records.h"
#include "compiler/frontend/syntax/scope.h"
#include "compiler/frontend/syntax/syntax.h"
#include "compiler/source/diagnostics.h"

namespace fathom::compiler {

// True if the value is a colour string and a property of this type accepts one.
bool is_color_text(const syntax::Value& value, ValueType type, const Scope& scope);

// Returns three numbers from 0 to 1, or nullopt after a report.
std::optional<syntax::Value> read_color_text(const syntax::Value& value, Diagnostics& diagnostics);

// Returns the colour string for three whole numbers from 0 to 255, as other programs write colours. At least one
// number must be 16 or more. Returns "" for other values.
std::string color_text_of(const syntax::Value& value);

}  // namespace fathom::compiler
