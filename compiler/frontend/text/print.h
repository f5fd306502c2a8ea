// Printer of a JSON scene as an equivalent text (docs/reference/language.md). Reading the text gives an equal tree.
// Tested by: tests/compiler/frontend/text/text_convert_test.cpp
#pragma once

#include <string>

#include "compiler/frontend/syntax/syntax.h"

namespace fathom::compiler::text {

// `file` is a scene without errors, as its front end read it. `source` is its text. Keeps each comment of the source
// next to the statement it belongs to.
std::string print_text(const syntax::File& file, const Source& source);

}  // namespace fathom::compiler::text
