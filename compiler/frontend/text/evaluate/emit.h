// From the values of a scene's text to the scene that a JSON file would have said.
//
// A node that a `let` of the file names is an entry of `nodes`; so is one that was given a name within the file's
// functions and loops and is met more than once. All others stand where they are met.
// Tested by: tests/compiler/frontend/text/text_evaluate_test.cpp
#pragma once

#include "compiler/frontend/syntax/syntax.h"
#include "compiler/frontend/text/evaluate/evaluate.h"
#include "compiler/source/diagnostics.h"

namespace fathom::compiler::text {

syntax::File to_syntax(const Tree& tree, const Evaluated& evaluated, const Limits& limits, Diagnostics& diagnostics);

}  // namespace fathom::compiler::text
