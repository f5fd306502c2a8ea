// The order in which a text's statements can be evaluated: each after those that it uses.
// Tested by: tests/compiler/frontend/text/text_evaluate_test.cpp, tests/golden/diagnostics (E0806)
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "compiler/frontend/text/parse/tree.h"
#include "compiler/source/diagnostics.h"

namespace fathom::compiler::text {

// A statement, and where another uses it.
struct UseOf {
  std::uint32_t statement;
  Span span;
};

// The statements that the file, module 0, leads to. nullopt after a report when one is made of itself, whether the
// file leads to it or not. `uses` are of each statement.
std::optional<std::vector<std::uint32_t>> in_order(const Tree& tree, const std::vector<std::vector<UseOf>>& uses,
                                                   Diagnostics& diagnostics);

}  // namespace fathom::compiler::text
