// Colours as texts: "#c04020" or "#c42", red, green and blue in hexadecimal, as a screen shows them (sRGB, IEC 61966-2-1).
// A scene's colours are linear, so a text is decoded where it is read. Formulas never begin with "#".
// Tested by: tests/compiler/frontend/records/color_text_test.cpp, tests/golden/diagnostics (E0101_color_text, E0104_albedo)
#pragma once

#include <optional>
#include <string>

#include "compiler/frontend/records/records.h"
#include "compiler/frontend/syntax/syntax.h"
#include "compiler/source/diagnostics.h"

namespace fathom::compiler {

// Whether a property of this type has such a text as its value.
bool is_color_text(const syntax::Value& value, ValueType type);

// Three numbers from 0 to 1; nullopt after a report.
std::optional<syntax::Value> read_color_text(const syntax::Value& value, Diagnostics& diagnostics);

// The text of three whole numbers from 0 to 255 of which one is 16 or more, as others write colours; "" of other values.
std::string color_text_of(const syntax::Value& value);

}  // namespace fathom::compiler
