// What the writer of an unknown word may have meant.
// Tested by: tests/golden/diagnostics (E0102, E0201), tests/compiler/frontend/elaborate/elaborate_test.cpp
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace fathom::compiler {

// The known word that `word` is another program's word for, or a misspelling of; empty when there is none.
std::string_view suggest(std::string_view word, const std::vector<std::string_view>& known);

// The line for "= help:": "did you mean `fov`? known: fov, position, target", the known words sorted; "" when none
// are known.
std::string did_you_mean(std::string_view word, const std::vector<std::string_view>& known);

}  // namespace fathom::compiler
