// Lowest point of a solid. Tested by: tests/compiler/frontend/stage_test.cpp
#pragma once

#include "compiler/geometry/box.h"
#include "vm/program/verify.h"

namespace fathom::compiler {

// Returns the height of the lowest point inside a solid, scene units, among the points of a grid over a finite box
// and of a finer grid right below the lowest such point. May miss parts narrower than a 64th of the box. Returns the
// box's lowest height if no grid point is inside.
double lowest(const vm::Code& program, const Box& box);

}  // namespace fathom::compiler
