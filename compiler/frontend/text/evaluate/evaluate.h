// Evaluates a scene's text: parameters, names, functions and loops, until nothing is left but values.
//
// It always ends. Functions cannot call themselves (frontend/text/parse/names.h), loops go over lists, and every expression
// that is evaluated is a step, of which there is a limit.
// Tested by: tests/compiler/frontend/text/text_evaluate_test.cpp, tests/golden/diagnostics (E0805 ...)
#pragma once

#include <vector>

#include "compiler/frontend/records/parameters.h"
#include "compiler/frontend/text/evaluate/evaluated.h"
#include "compiler/frontend/text/parse/tree.h"
#include "compiler/source/diagnostics.h"
#include "compiler/source/limits.h"

namespace fathom::compiler::text {

// `order` is that of frontend/text/parse/names.h. With `keep_formulas` numbers keep how they came about (Value::spelling).
Evaluated evaluate(const Tree& tree, const std::vector<std::uint32_t>& order, const Definitions& definitions,
                   const Limits& limits, Diagnostics& diagnostics, bool keep_formulas = false);

}  // namespace fathom::compiler::text
