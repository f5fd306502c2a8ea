// Order of evaluation of a text's statements: each statement comes after the statements that it uses.
// Tested by: tests/compiler/frontend/text/text_evaluate_test.cpp, tests/golden/diagnostics (E0806)
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "compiler/frontend/text/parse/tree.h"
#include "compiler/source/diagnostics.h"

namespace fathom::compiler::text {

// A used statement, and the place of the use.
struct UseOf {
  std::uint32_t statement;
  Span span;
};

// Returns the statements reachable from the scene file, module 0, in order. Returns nullopt after reporting a cycle,
// even if the cycle is not reachable. `uses` has one list per statement.
std::optional<std::vector<std::uint32_t>> in_order(const Tree& tree, const std::vector<std::vector<UseOf>>& uses,
                                                   Diagnostics& diagnostics);

}  // namespace fathom::compiler::text
