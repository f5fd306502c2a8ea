// Name resolution for texts. Runs before evaluation, so that a misspelt name is an error even in a branch that is not
// taken, and recursion is detected without calling a function.
// Tested by: tests/compiler/frontend/text/text_evaluate_test.cpp, tests/golden/diagnostics (E0802, E0803, E0804, E0806)
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "compiler/frontend/text/parse/tree.h"
#include "compiler/source/diagnostics.h"

namespace fathom::compiler::text {

// Sets the references, words and slots of the tree and reports errors. Returns the statements to evaluate, each after
// the statements that it uses, or nullopt if the uses form a cycle.
std::optional<std::vector<std::uint32_t>> resolve_names(Tree& tree, Diagnostics& diagnostics);

}  // namespace fathom::compiler::text
