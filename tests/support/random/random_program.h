// Seeded random programs that verify: every opcode, mode and operand source, with constants from the whole range of
// float.
#pragma once

#include "tests/support/random/random_scene.h"
#include "vm/program/verify.h"

namespace fathom::test {

// Returns a program of about `instructions` instructions.
vm::VerifiedProgram random_program(Random& random, int instructions);

// Returns a number that rounds to a finite f32: an integer, a number of few digits, or one of any magnitude.
double random_constant(Random& random);

}  // namespace fathom::test
