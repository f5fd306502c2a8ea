// Seeded random scene documents as a front end reads them: every node, material, pattern, light and background of the
// tables, with formulas of parameters and of x, y and z, and with names that no language would choose. Their
// properties are those of the tables; what the numbers mean together nobody has looked at.
#pragma once

#include <string>

#include "compiler/frontend/syntax/syntax.h"
#include "tests/support/random/random_scene.h"

namespace fathom::test {

compiler::syntax::File random_document(Random& random);

// The tree with the properties of each record in one order, without blanks in strings: equal for documents that say
// the same.
std::string canonical(const compiler::syntax::Value& value);

}  // namespace fathom::test
