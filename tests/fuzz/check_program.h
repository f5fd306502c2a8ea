// What must hold of every program that the machine runs, whatever scene it is of.
#pragma once

#include "tests/support/random/random_scene.h"
#include "vm/program/verify.h"

namespace fathom::fuzz {

// Programs that take longer than a fuzz run has time for say nothing new.
inline constexpr std::uint32_t kMostCost = 20'000;  // multiply-adds a point

// At random points and in random boxes near `middle`, of about the size `reach`: the same bits one point at a time
// and many at once, on every instruction set, in float and in double; the surface's distance is the distance; ranges
// and enclosures hold the values; parts cut for boxes give the whole program's bits there. Throws BrokenPromise.
void check_program(const vm::VerifiedProgram& program, test::Random& random, double reach = 2);

// The bits alone: what ranges and parts rely on, that a plane's normal has length 1 and the like, a stranger's
// program need not keep.
void check_evaluation(const vm::VerifiedProgram& program, test::Random& random, double reach = 2);

}  // namespace fathom::fuzz
