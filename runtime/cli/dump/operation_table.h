// What a program spends its time on, by operation and by place in the scene, as tables for people.
// Tested by: tests/runtime/cli/cli_dump_test.cpp
#pragma once

#include <string>

#include "vm/program/verify.h"

namespace fathom::cli {

// Operations that occur, the most expensive first; costs are multiply-adds a point.
std::string operation_table(const vm::VerifiedProgram& program);

// The same by the node of the scene that instructions come from: type and name, where it is written.
std::string cost_by_node(const vm::VerifiedProgram& program);

}  // namespace fathom::cli
