// What the names in a scene's text stand for, found before anything is evaluated: so that a misspelt name is an error
// in a branch that is not taken, too, and a function that calls itself is found without calling it.
// Tested by: tests/compiler/frontend/text/text_evaluate_test.cpp, tests/golden/diagnostics (E0802, E0803, E0804, E0806)
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "compiler/frontend/text/parse/tree.h"
#include "compiler/source/diagnostics.h"

namespace fathom::compiler::text {

// Fills in the references, words and slots of the tree, and returns its statements with a value in an order in which
// each comes after those it uses; reports what is wrong. nullopt when there is no such order.
std::optional<std::vector<std::uint32_t>> resolve_names(Tree& tree, Diagnostics& diagnostics);

}  // namespace fathom::compiler::text
