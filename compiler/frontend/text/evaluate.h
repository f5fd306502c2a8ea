// Evaluates a scene's text: parameters, names, functions and loops, until nothing is left but values.
//
// It always ends. Functions cannot call themselves (frontend/text/names.h), loops go over lists, and every expression
// that is evaluated is a step, of which there is a limit.
// Tested by: tests/compiler/text_evaluate_test.cpp, tests/golden/diagnostics (E0805 ...)
#pragma once

#include <vector>

#include "compiler/diagnostics.h"
#include "compiler/frontend/parameters.h"
#include "compiler/frontend/text/evaluated.h"
#include "compiler/frontend/text/tree.h"
#include "compiler/limits.h"

namespace fathom::compiler::text {

// `order` is that of frontend/text/names.h. With `keep_formulas` numbers keep how they came about (Value::spelling).
Evaluated evaluate(const Tree& tree, const std::vector<std::uint32_t>& order, const Definitions& definitions,
                   const Limits& limits, Diagnostics& diagnostics, bool keep_formulas = false);

}  // namespace fathom::compiler::text
