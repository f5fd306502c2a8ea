// Scenes as JSON text: read_json() makes the same of it, up to spans. A value is on one line where that is short.
// Tested by: tests/compiler/nested_nodes_test.cpp, tests/compiler/expression_list_test.cpp
#pragma once

#include <string>

#include "compiler/frontend/syntax.h"

namespace fathom::compiler {

std::string write_json(const syntax::File& file);

}  // namespace fathom::compiler
