// Promises that hold for every program that the machine runs, whatever scene it comes from.
#pragma once

#include "tests/support/random/random_scene.h"
#include "vm/program/verify.h"

namespace fathom::fuzz {

// Programs above this cost take longer than a fuzz run allows, and reveal nothing new.
inline constexpr std::uint32_t kMaxCost = 20'000;  // multiply-adds per point

// Checks a program at random points and in random boxes within about `reach` of the origin. The bits are equal for
// one point at a time and for many, on every instruction set, in float and in double. The surface's distance is the
// distance. Ranges and enclosures contain the values. Parts specialised for boxes give the whole program's bits in
// them. Throws BrokenPromise.
void check_program(const vm::VerifiedProgram& program, test::Random& random, double reach = 2);

// Checks the bits only. Ranges and parts rely on properties (e.g. unit normals of planes) that a program from a file
// of unknown origin need not have.
void check_evaluation(const vm::VerifiedProgram& program, test::Random& random, double reach = 2);

}  // namespace fathom::fuzz
