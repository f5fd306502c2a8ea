// A program: immutable stack bytecode in 32-bit words, with a debug table.
//
// An instruction is an opcode word and the immediates that its row in vm/program/opcodes.def names. A program runs on
// two stacks: points (x, y, z) and values (distances). The program starts with one point, the caller's, and ends with
// one value, the distance:
//
//     translate 0 1 0     ; p      -> p p-(0,1,0)
//     sphere 0.5          ; p p'   -> value |p'| - 0.5
//     drop                ; p p'   -> p
//
// The flags kFusedTranslate and kFusedMin (vm/program/opcode.h) fuse these three instructions into one, and also a
// min that follows:
//
//     sphere 0.5 at 0 1 0
//     sphere 0.5 at 0 1 0 min
//
// Functions can take operands from the stack (`_`), from a coordinate, a constant or a local: add _ x, multiply 2 _,
// min _ %3.
//
// An Outline row's instruction has as many groups of immediates as its operand says: polygon 3  0 0  1 0  0 1.
//
// Immediates in the words are f32. `wide` holds the same constants unrounded for evaluation in double, so that a
// scene far from the origin keeps its features. A Program is untrusted data; only vm/program/verify.h makes it
// runnable.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "vm/program/opcode.h"

namespace fathom::vm {

// Source location of an instruction: one entry per instruction, in order.
struct DebugEntry {
  std::uint32_t offset;  // of the opcode word, in words
  std::uint32_t line;    // 1-based; 0 when unknown
  std::uint32_t column;  // 1-based, in code points
  std::string symbol;    // e.g. sphere "ball"; may be empty
};

struct Program {
  std::vector<std::uint32_t> words;
  std::vector<double> doubles;  // [word] the immediate in double; 0 at opcode words and integers
  std::uint32_t locals = 0;  // number of locals
  std::string source_name;   // name of the text that the debug entries refer to
  std::vector<DebugEntry> debug;

  // Appends an instruction. `immediates` begins with the leading immediates. An Outline's `immediates` hold the
  // groups in order, and their number becomes the operand. Floats are rounded to f32, integers must be representable.
  void append(Opcode opcode, std::uint32_t operand, const std::vector<double>& immediates, DebugEntry entry);
};

}  // namespace fathom::vm
