// Seeded random programs that verify: every opcode, mode and source, with numbers from all of float.
#pragma once

#include "tests/support/random/random_scene.h"
#include "vm/program/verify.h"

namespace fathom::test {

// About `instructions` of them.
vm::VerifiedProgram random_program(Random& random, int instructions);

// A number that rounds to a finite f32: whole, of few digits, or of any magnitude.
double random_constant(Random& random);

}  // namespace fathom::test
