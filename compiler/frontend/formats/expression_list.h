// Reader for formulas as lists of operations, one per line: the format of the models of Fidget (Keeter) and of the
// Prospero challenge, by convention in files named *.vm.
//
//     # comment
//     _0 const 2.95
//     _1 var-x
//     _2 mul _0 _1        a name, an operation, names of lines above; the last line is the result
//
// The solid is the set of points where the formula is negative, within the box from (-1,-1,-1) to (1,1,1). A formula
// without z is constant in z over that box. The half height 1 of the box affects the field at z = 0 only where the
// formula is below minus its Lipschitz constant, which is impossible within distance 1 of a zero of the formula.
// Tested by: tests/compiler/frontend/formats/expression_list_test.cpp, tests/golden/diagnostics (E0601 to E0606)
#pragma once

#include <optional>
#include <string_view>

#include "compiler/frontend/syntax/syntax.h"
#include "compiler/source/diagnostics.h"
#include "compiler/source/limits.h"

namespace fathom::compiler {

// True if the first line that is neither empty nor a # comment consists of a name and a word. Also true for a text
// that contains comments only.
bool is_expression_list(std::string_view text);

// Returns a scene with one `expression` in front of a camera, or nullopt after a report.
std::optional<syntax::File> read_expression_list(const Source& source, Diagnostics& diagnostics,
                                                 const Limits& limits = {});

}  // namespace fathom::compiler
