// A program's listing with its stacks at one point after every instruction, for `fathom dump --run`.
// Tested by: tests/runtime/cli/cli_dump_test.cpp
#pragma once

#include <glm/vec3.hpp>
#include <string>

#include "vm/program/verify.h"

namespace fathom::cli {

// What a trace takes, in multiply-adds: it grows with the square of the length. More than a second or two is refused.
double trace_work(const vm::VerifiedProgram& program);
inline constexpr double kMostTraceWork = 1e9;

// `point` is in the program's coordinates. The stacks stand in comments, so the assembler reads the listing as ever.
// It ends with the first instruction that left a NaN or an infinity, if one did.
std::string trace_listing(const vm::VerifiedProgram& program, glm::dvec3 point);

}  // namespace fathom::cli
