// Conversion of the values of a text to a syntax tree, as a JSON file would describe the scene.
//
// Named nodes (entries of `nodes`) are the nodes that a `let` of the file names, and nodes that are used more than
// once or nested too deeply. A node of the second kind has the name given within the file's functions and loops, if
// any. All other nodes are placed where they are used.
// Tested by: tests/compiler/frontend/text/text_evaluate_test.cpp
#pragma once

#include "compiler/frontend/syntax/syntax.h"
#include "compiler/frontend/text/evaluate/evaluate.h"
#include "compiler/source/diagnostics.h"

namespace fathom::compiler::text {

syntax::File to_syntax(const Tree& tree, const Evaluated& evaluated, const Limits& limits, Diagnostics& diagnostics);

}  // namespace fathom::compiler::text
