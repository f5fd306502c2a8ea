// Seeded random scene documents as a front end reads them: every node, material, pattern, light and background of the
// tables, with formulas of parameters and of x, y and z, and with names that no language would choose. The properties
// follow the tables. The values are not checked for consistency with each other.
#pragma once

#include <string>

#include "compiler/frontend/syntax/syntax.h"
#include "tests/support/random/random_scene.h"

namespace fathom::test {

compiler::syntax::File random_document(Random& random);

// Prints the tree with the properties of each record sorted and strings without blanks. Equal for documents with the
// same meaning.
std::string canonical(const compiler::syntax::Value& value);

}  // namespace fathom::test
