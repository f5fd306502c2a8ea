// A formula as the text that reads back as the same formula.
// Tested by: tests/compiler/frontend/formula/formula_test.cpp
#pragma once

#include <string>
#include <vector>

#include "compiler/frontend/formula/formula.h"

namespace fathom::compiler {

// The lines of a JSON scene's formula: what is used twice has a name, `a = ...`, and the last line is the result.
std::vector<std::string> formula_lines(const Formula& formula);

}  // namespace fathom::compiler
