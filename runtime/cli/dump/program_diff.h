// Differences between two programs, for `fathom dump --diff a b`.
// Tested by: tests/runtime/cli/cli_dump_test.cpp
#pragma once

#include <string>

#include "vm/program/verify.h"

namespace fathom::cli {

struct DiffSide {
  std::string name;  // as shown in the output
  const vm::VerifiedProgram& program;
};

// Returns the sizes and a unified diff of the instructions. Instructions are equal if they have the same operation
// and the same numbers, regardless of their offsets. For equal programs the result is a single line.
std::string program_diff(const DiffSide& before, const DiffSide& after);

}  // namespace fathom::cli
