// A scene's text as a tree: recursive descent by the grammar of docs/LANGUAGE.md.
//
// A statement ends where a line begins that is not indented further than the statement's first word; there the parser
// goes on after an error, so that several are reported.
// Tested by: tests/compiler/text_parser_test.cpp, tests/golden/diagnostics (E08xx)
#pragma once

#include <optional>
#include <string_view>

#include "compiler/frontend/text/parse/tree.h"
#include "compiler/source/diagnostics.h"
#include "compiler/source/limits.h"

namespace fathom::compiler::text {

inline constexpr int kTextVersion = 1;

// The tree holds parts of the source's text. What is in error is left out of it.
ParsedFile parse(const Source& source, Diagnostics& diagnostics, const Limits& limits);

}  // namespace fathom::compiler::text
