// The listing of a program: one line an instruction, after the layout of other bytecode tools.
//
//       off  words  values  points  cost  op                               ; source
//      0000      4       0    1->2     1  translate 0 1 0                  ; scene.json:6:5 transform "ball"
//
// off: of the opcode word, in words. values, points: the stacks' heights before and after.
//
// Numbers print with the fewest digits that read back to the same float, so that the listing loses nothing.
// Tested by: tests/golden (dumps)
#pragma once

#include <string>

#include "vm/verify.h"

namespace fathom::vm {

std::string disassemble(const VerifiedProgram& program);

}  // namespace fathom::vm
