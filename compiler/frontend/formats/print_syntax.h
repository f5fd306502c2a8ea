// Printer for the syntax tree, for `fathom dump --syntax`.
// Tested by: tests/compiler/frontend/syntax/json_test.cpp
#pragma once

#include <string>

#include "compiler/frontend/syntax/syntax.h"

namespace fathom::compiler::syntax {

std::string print_syntax(const File& file);

}  // namespace fathom::compiler::syntax
