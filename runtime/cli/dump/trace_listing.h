// A program's listing with its stacks at one point after every instruction, for `fathom dump --run`.
// Tested by: tests/runtime/cli/cli_dump_test.cpp
#pragma once

#include <glm/vec3.hpp>
#include <string>

#include "vm/program/verify.h"

namespace fathom::cli {

// Returns the cost of a trace in multiply-adds, which is quadratic in the program's length. `fathom dump` refuses
// traces above kMaxTraceWork, which takes a second or two.
double trace_work(const vm::VerifiedProgram& program);
inline constexpr double kMaxTraceWork = 1e9;

// Returns the listing with stacks at `point`, in the program's coordinates. The stacks are comments, so that the
// assembler accepts the listing. The last line names the first instruction that produced a NaN or an infinity, if any
// did.
std::string trace_listing(const vm::VerifiedProgram& program, glm::dvec3 point);

}  // namespace fathom::cli
