// One layout for all texts: blanks and indentation are the formatter's, lines the author's.
// Tested by: tests/compiler/frontend/text/text_format_test.cpp
#pragma once

#include <string>

#include "compiler/source/source.h"

namespace fathom::compiler::text {

// The text, which has no syntax errors, with the same tokens and comments. Formatting what it returns changes nothing.
std::string format_text(const Source& source);

}  // namespace fathom::compiler::text
