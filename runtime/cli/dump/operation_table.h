// Tables of a program's cost by operation and by node of the scene.
// Tested by: tests/runtime/cli/cli_dump_test.cpp
#pragma once

#include <string>

#include "vm/program/verify.h"

namespace fathom::cli {

// Returns the operations that occur, the most expensive first. Costs are multiply-adds per point.
std::string operation_table(const vm::VerifiedProgram& program);

// Returns the cost per node of the scene, with the node's type, name and source location.
std::string cost_by_node(const vm::VerifiedProgram& program);

}  // namespace fathom::cli
