// Suggestions for unknown words.
// Tested by: tests/golden/diagnostics (E0102, E0201), tests/compiler/frontend/elaborate/elaborate_test.cpp
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace fathom::compiler {

// Returns the known word that `word` is a misspelling of or another program's term for, or "" if there is none.
std::string_view suggest(std::string_view word, const std::vector<std::string_view>& known);

// Returns how a text says a term of other programs, or what a function of numbers is meant to do with bodies, or "".
std::string_view foreign_help(std::string_view word);

// Returns the line for "= help:", such as "did you mean `fov`? known: fov, position, target", with the known words
// sorted. Returns "" if `known` is empty.
std::string did_you_mean(std::string_view word, const std::vector<std::string_view>& known);

}  // namespace fathom::compiler
