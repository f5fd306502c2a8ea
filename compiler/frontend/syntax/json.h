// Parser for JSON scenes with // and /* */ comments. nlohmann/json tokenises, and this code adds the source spans.
// Tested by: tests/compiler/frontend/syntax/json_test.cpp
#pragma once

#include <optional>

#include "compiler/frontend/syntax/syntax.h"
#include "compiler/source/diagnostics.h"
#include "compiler/source/limits.h"

namespace fathom::compiler {

// Returns nullopt after a syntax error, which ends parsing. Duplicate keys are errors too, and all of them are
// reported.
std::optional<syntax::File> read_json(const Source& source, Diagnostics& diagnostics, const Limits& limits = {});

}  // namespace fathom::compiler
