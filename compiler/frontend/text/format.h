// Formatter with one layout for all texts: it sets blanks and indentation, and keeps the author's line breaks.
// Tested by: tests/compiler/frontend/text/text_format_test.cpp
#pragma once

#include <string>

#include "compiler/source/source.h"

namespace fathom::compiler::text {

// Returns the text with the same tokens and comments. The text must have no syntax errors. Formatting the result
// again changes nothing.
std::string format_text(const Source& source);

}  // namespace fathom::compiler::text
