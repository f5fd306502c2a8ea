// The listing of a program: one line an instruction, after the layout of other bytecode tools. vm/encoding/assemble.h reads it
// back, to the word.
//
//       off  words  values  points  cost  op                               ; source
//      0000      4       0    1->2     1  translate 0 1 0                  @6:5 transform "ball"
//
// off: of the opcode word, in words. values, points: the stacks' heights before and after. @: line and column in the
// source named above, and the node.
//
// Numbers are what the machine in double sees, with the fewest digits that read back to the same.
// Tested by: tests/vm/encoding/assemble_test.cpp, tests/golden (dumps)
#pragma once

#include <cstddef>
#include <string>

#include "vm/program/verify.h"

namespace fathom::vm {

std::string disassemble(const VerifiedProgram& program);

// The instruction whose opcode word is at `offset`: "translate 0 1 0".
std::string instruction_text(const Program& program, std::size_t offset);

}  // namespace fathom::vm
