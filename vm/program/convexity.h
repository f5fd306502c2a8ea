// The share of convex shapes in a program. Tested by: tests/vm/program/convexity_test.cpp
#pragma once

#include "vm/program/verify.h"

namespace fathom::vm {

// Returns the share of a program's cost, in [0,1], that goes to convex shapes at points reached by affine maps alone.
// Other maps do not preserve convexity.
double convex_share(const Code& program);

}  // namespace fathom::vm
