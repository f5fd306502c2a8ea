// How far down a solid reaches. Tested by: tests/compiler/frontend/stage_test.cpp
#pragma once

#include "compiler/geometry/box.h"
#include "vm/program/verify.h"

namespace fathom::compiler {

// The height of the lowest point inside a solid, of those of a grid over a finite box, and of a finer one right below
// it; scene units. Parts narrower than a 64th of the box may be passed over. The box's lowest where nothing is solid.
double lowest(const vm::Code& program, const Box& box);

}  // namespace fathom::compiler
