// Printer for formulas. The text reads back as the same formula.
// Tested by: tests/compiler/frontend/formula/formula_test.cpp
#pragma once

#include <string>
#include <vector>

#include "compiler/frontend/formula/formula.h"

namespace fathom::compiler {

// Returns the lines of a JSON scene's formula. A subexpression that is used twice gets a name (`a = ...`), and the
// last line is the result.
std::vector<std::string> formula_lines(const Formula& formula);

}  // namespace fathom::compiler
