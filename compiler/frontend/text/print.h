// A JSON scene as the text that says the same (docs/LANGUAGE.md): reading it gives an equal tree.
// Tested by: tests/compiler/frontend/text/text_convert_test.cpp
#pragma once

#include <string>

#include "compiler/frontend/syntax/syntax.h"

namespace fathom::compiler::text {

// `file` is a scene without errors, as its front end read it; `source` is its text, whose comments are kept beside
// what they are about.
std::string print_text(const syntax::File& file, const Source& source);

}  // namespace fathom::compiler::text
