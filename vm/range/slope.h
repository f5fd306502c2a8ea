// Slopes: the values, the slope and the float error that a program has over one box of exact numbers, and the ranges
// that its choices choose from. Tested by: tests/vm/interpret/formula_test.cpp, tests/vm/prune/specialise_test.cpp
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "vm/interpret/evaluate.h"
#include "vm/range/choice_bounds.h"

namespace fathom::vm {

// The bounds that a program keeps over the box [lo, hi]: vm/number/slope-inl.h has the rules. Bounds are infinite
// where nothing is known, as where the value may jump.
struct SlopeBound {
  Range value;
  double lipschitz;    // |f(p) - f(q)| <= lipschitz |p - q| in the box
  double float_error;  // |f32 value - exact value| at f32 points of the box, scene units
};
SlopeBound evaluate_slope(const Code& program, glm::dvec3 lo, glm::dvec3 hi, Workspace& workspace);

// evaluate_slope(), and the ranges of every choice's operands. These hold for f32 as above and for the exact
// values, the program's constants unrounded; both at points where every operation of the program is defined.
SlopeBound enclose_slope(const Code& program, glm::dvec3 lo, glm::dvec3 hi, std::vector<ChoiceRange>& choices,
                         Workspace& workspace);

}  // namespace fathom::vm
