// Formulas as lists of operations, a line each: the format of the models of Fidget (Keeter) and of the Prospero
// challenge, by custom in files named *.vm.
//
//     # comment
//     _0 const 2.95
//     _1 var-x
//     _2 mul _0 _1        a name, an operation, names of lines above; the last line is the result
//
// The solid is where the formula is negative, within the box from (-1,-1,-1) to (1,1,1). A formula without z is the
// same at every height of that box. The half height 1 never shows at z = 0 unless the formula is deeper than its
// Lipschitz constant, which it cannot be within 1 of a point where it is 0.
// Tested by: tests/compiler/frontend/formats/expression_list_test.cpp, tests/golden/diagnostics (E0601 to E0606)
#pragma once

#include <optional>
#include <string_view>

#include "compiler/frontend/syntax/syntax.h"
#include "compiler/source/diagnostics.h"
#include "compiler/source/limits.h"

namespace fathom::compiler {

// By its first line that is neither empty nor a # comment: a name, then a word. Text with comments alone is one too.
bool is_expression_list(std::string_view text);

// A scene with one `expression`, in front of a camera; nullopt after reporting what is wrong.
std::optional<syntax::File> read_expression_list(const Source& source, Diagnostics& diagnostics,
                                                 const Limits& limits = {});

}  // namespace fathom::compiler
