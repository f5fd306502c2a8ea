// How often each operation occurs in a program and what it costs, as a table for people.
// Tested by: tests/runtime/cli_test.cpp
#pragma once

#include <string>

#include "vm/verify.h"

namespace fathom::cli {

// Operations that occur, the most expensive first; costs are multiply-adds a point.
std::string operation_table(const vm::VerifiedProgram& program);

}  // namespace fathom::cli
