// What two programs differ in, for `fathom dump --diff a b`.
// Tested by: tests/runtime/cli/cli_dump_test.cpp
#pragma once

#include <string>

#include "vm/program/verify.h"

namespace fathom::cli {

struct DiffSide {
  std::string name;  // for people
  const vm::VerifiedProgram& program;
};

// Their sizes, then a unified diff of their instructions, which are equal where they do the same with the same
// numbers, wherever they stand; nothing but a line that says so when the programs are equal.
std::string program_diff(const DiffSide& before, const DiffSide& after);

}  // namespace fathom::cli
