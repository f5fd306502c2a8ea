// A program: immutable stack bytecode in 32-bit words, with a debug table beside it.
//
// An instruction is an opcode word and the immediates its row in vm/program/opcodes.def names. It runs on two stacks: points
// (x, y, z) and values (distances). It starts with one point, the caller's, and ends with one value, the distance:
//
//     translate 0 1 0     ; p      -> p p-(0,1,0)
//     sphere 0.5          ; p p'   -> value |p'| - 0.5
//     drop                ; p p'   -> p
//
// What an operand adds to a row (vm/program/opcode.h) makes one instruction of these three, and one of two with a min that
// would follow:
//
//     sphere 0.5 at 0 1 0
//     sphere 0.5 at 0 1 0 min
//
// and lets functions take operands from elsewhere than the stack, `_`: add _ x, multiply 2 _, min _ %3 (a local).
//
// An Outline row's instruction has as many groups of immediates as its operand says: polygon 3  0 0  1 0  0 1.
//
// Immediates are f32 in the words; `wide` holds the same constants unrounded for evaluation in double, so that a
// scene far from the origin keeps its features. A Program is data from anywhere; only vm/program/verify.h makes it runnable.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "vm/program/opcode.h"

namespace fathom::vm {

// Where an instruction comes from: one entry per instruction, in order.
struct DebugEntry {
  std::uint32_t offset;  // of the opcode word
  std::uint32_t line;    // 1-based; 0 when unknown
  std::uint32_t column;  // 1-based, in code points
  std::string symbol;    // e.g. sphere "ball"; may be empty
};

struct Program {
  std::vector<std::uint32_t> words;
  std::vector<double> wide;  // [word] the immediate in double; 0 at opcode words and integers
  std::uint32_t locals = 0;  // how many locals tee and load may name
  std::string source_name;   // of the debug entries' lines
  std::vector<DebugEntry> debug;

  // Appends an instruction; of an Outline, `immediates` holds the groups in order and makes the operand. Leading
  // immediates come first. Floats are
  // rounded from `immediates`, integers must be representable.
  void append(Opcode opcode, std::uint32_t operand, const std::vector<double>& immediates, DebugEntry entry);
};

}  // namespace fathom::vm
