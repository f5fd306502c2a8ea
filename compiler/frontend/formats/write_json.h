// Writer for scenes as JSON text. read_json() reads the same scene back, except for spans. Short values are written
// on one line.
// Tested by: tests/compiler/frontend/formats/nested_nodes_test.cpp, tests/compiler/frontend/formats/expression_list_test.cpp
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "compiler/frontend/syntax/syntax.h"

namespace fathom::compiler {

// Comments, including their marks, keyed by the source offset of the property or list element after the comment.
// Covers the scene's own properties and the entries of its tables and lists.
using JsonComments = std::multimap<std::uint32_t, std::string>;

std::string write_json(const syntax::File& file, const JsonComments& comments = {});

}  // namespace fathom::compiler
