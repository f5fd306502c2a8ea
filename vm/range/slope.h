// Bounds of a program over one box of exact numbers: of its values, its slope, its float error and its choices'
// operands.
// Tested by: tests/vm/interpret/formula_test.cpp, tests/vm/prune/specialise_test.cpp
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "vm/interpret/evaluate.h"
#include "vm/range/choice_bounds.h"

namespace fathom::vm {

// Bounds of a program over the box [lo, hi], by the rules of vm/number/slope-inl.h. Unknown bounds are infinite, for
// example where the value may jump.
struct SlopeBound {
  Range value;
  double lipschitz;    // |f(p) - f(q)| <= lipschitz |p - q| in the box
  double float_error;  // bound on |f32 value - exact value| at f32 points of the box, in scene units
};
SlopeBound evaluate_slope(const Code& program, glm::dvec3 lo, glm::dvec3 hi, Workspace& workspace);

// Computes evaluate_slope() and the ranges of every choice's operands. The ranges hold for f32 values and for exact
// values with unrounded constants, at points where every operation of the program is defined.
SlopeBound enclose_slope(const Code& program, glm::dvec3 lo, glm::dvec3 hi, std::vector<ChoiceRange>& choices,
                         Workspace& workspace);

}  // namespace fathom::vm
