// Reads the listings of vm/encoding/disassemble.h: assemble(disassemble(p)) is p, word for word, with its debug
// entries.
//
//     locals 1
//     source "scene.json"
//     sphere 0.5 at 0 1 0          @6:5 sphere "ball"
//     tee 0
//     min _ %0
//
// A line is an instruction. The listing's columns (offset, length, stack heights, cost) may precede the instruction
// and are ignored, so edited listings can be assembled too. `;` begins a comment. `@line:column` and the rest of the
// line are the instruction's source location and symbol. Numbers are decimal. Float immediates are read as doubles,
// the constants of evaluation in double, and are rounded to f32 for evaluation in f32.
//
// Tested by: tests/vm/encoding/assemble_test.cpp, tests/golden (assembly)
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "vm/program/program.h"

namespace fathom::vm {

struct AssembleError {
  std::size_t begin, end;  // range of bytes at fault in the text
  std::string reason;
  bool unknown_instruction = false;  // true if [begin, end) is not a mnemonic but should be
};

// Returns the unverified program of `text`; vm/program/verify.h checks it. A text without any source location (@)
// gives no debug entries. `lines`, if not null, is set to where the line of each instruction, or of its row, begins.
// `most`: maximum number of instructions of a program with rows.
[[nodiscard]] std::variant<Program, AssembleError> assemble(std::string_view text,
                                                            std::vector<std::size_t>* lines = nullptr,
                                                            std::size_t most = 1'000'000);

}  // namespace fathom::vm
