// Recursive descent parser for texts, by the grammar of docs/reference/language.md.
//
// A statement ends at a line that is not indented further than the statement's first word. After an error the parser
// continues at the next such line, so that it reports several errors.
// Tested by: tests/compiler/frontend/text/text_evaluate_test.cpp, tests/golden/diagnostics (E08xx)
#pragma once

#include <optional>
#include <string_view>

#include "compiler/frontend/text/parse/tree.h"
#include "compiler/source/diagnostics.h"
#include "compiler/source/limits.h"

namespace fathom::compiler::text {

inline constexpr int kTextVersion = 1;

// Returns the statements without errors. Names in the tree point into the source's text.
ParsedFile parse(const Source& source, Diagnostics& diagnostics, const Limits& limits);

}  // namespace fathom::compiler::text
