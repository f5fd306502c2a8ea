// The listing of a program: one line per instruction, in the layout of other bytecode tools. vm/encoding/assemble.h
// reads a listing back, word for word.
//
//       off  words  values  points  cost  op                               ; source
//      0000      4       0    1->2     1  translate 0 1 0                  @6:5 transform "ball"
//
// off: offset of the opcode word, in words. values, points: the stacks' heights before and after. @: line and column
// in the source that the listing's `source` line names, and the node.
//
// Float immediates are the unrounded doubles, with the fewest digits that read back to the same value.
// Tested by: tests/vm/encoding/assemble_test.cpp, tests/golden (dumps)
#pragma once

#include <cstddef>
#include <string>

#include "vm/program/verify.h"

namespace fathom::vm {

std::string disassemble(const VerifiedProgram& program);

// Returns the text of the instruction whose opcode word is at `offset`, e.g. "translate 0 1 0".
std::string instruction_text(const Program& program, std::size_t offset);

}  // namespace fathom::vm
