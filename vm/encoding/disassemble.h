// The listing of a program: one line per instruction, in the layout of other bytecode tools. vm/encoding/assemble.h
// reads a listing back, word for word.
//
//       off  words  values  points  cost  op                               ; source
//      0000      4       0    1->2     1  translate 0 1 0                  @6:5 transform "ball"
//
// off: offset of the opcode word, in words. values, points: the stacks' heights before and after. @: line and column
// in the source that the listing's `source` line names, and the node.
//
// A body of instructions that repeats, with equal places, is listed once, and its numbers that differ as rows. The
// machine runs the rows one after another, as if the body was written for each:
//
//     each 5952
//       0005      5       1       1    10  sphere 0.085 at # # # min            @24:12 sphere "bead"
//     rows
//       0.071 1.988 0
//       0.411 1.832 -0.454
//     ...
//     end
//
// Float immediates are the unrounded doubles, with the fewest digits that read back to the same value.
// Tested by: tests/vm/encoding/assemble_test.cpp, tests/golden (dumps)
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>

#include "vm/program/verify.h"

namespace fathom::vm {

struct ListedRows {
  bool few = false;       // list the first and last rows of each body, which assemble() refuses
  bool unrolled = false;  // list every instruction
  // List the rows from the first number to before the second, counted from 0 over all bodies.
  std::optional<std::pair<std::size_t, std::size_t>> range = std::nullopt;
};
std::string disassemble(const VerifiedProgram& program, const ListedRows& rows = {});

// Returns the text of the instruction whose opcode word is at `offset`, e.g. "translate 0 1 0".
std::string instruction_text(const Program& program, std::size_t offset);

}  // namespace fathom::vm
