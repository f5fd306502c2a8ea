// Evaluator for texts. Resolves parameters, names, functions and loops to values.
//
// Evaluation always terminates. Functions cannot call themselves (compiler/frontend/text/parse/names.h), loops
// iterate over lists, every evaluated expression counts as a step, and the number of steps is limited. Tested by:
// tests/compiler/frontend/text/text_evaluate_test.cpp, tests/golden/diagnostics (E0805 ...)
#pragma once

#include <vector>

#include "compiler/frontend/records/parameters.h"
#include "compiler/frontend/text/evaluate/evaluated.h"
#include "compiler/frontend/text/parse/tree.h"
#include "compiler/source/diagnostics.h"
#include "compiler/source/limits.h"

namespace fathom::compiler::text {

// `order` comes from resolve_names() (compiler/frontend/text/parse/names.h). With `keep_formulas`, numbers keep the
// formulas that they come from (Value::spelling).
Evaluated evaluate(const Tree& tree, const std::vector<std::uint32_t>& order, const Definitions& definitions,
                   const Limits& limits, Diagnostics& diagnostics, bool keep_formulas = false);

}  // namespace fathom::compiler::text
