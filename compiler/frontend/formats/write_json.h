// Scenes as JSON text: read_json() makes the same of it, up to spans. A value is on one line where that is short.
// Tested by: tests/compiler/frontend/formats/nested_nodes_test.cpp, tests/compiler/frontend/formats/expression_list_test.cpp
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "compiler/frontend/syntax/syntax.h"

namespace fathom::compiler {

// Comments with their marks, by where the property or the element of a list that each stands before begins in the
// source: of the scene's own properties and of what its tables and lists hold.
using JsonComments = std::multimap<std::uint32_t, std::string>;

std::string write_json(const syntax::File& file, const JsonComments& comments = {});

}  // namespace fathom::compiler
