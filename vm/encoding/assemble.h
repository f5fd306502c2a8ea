// Reads what vm/encoding/disassemble.h writes: assemble(disassemble(p)) is p, word for word, with its debug entries.
//
//     locals 1
//     source "scene.json"
//     sphere 0.5 at 0 1 0          @6:5 sphere "ball"
//     tee 0
//     min _ %0
//
// A line is an instruction. In front of it may stand the listing's columns (offset, length, stack heights, cost),
// which are not looked at: a listing in which something was changed or added reads as what it says now. `;` begins a
// comment. `@line:column` and the rest of the line say where the instruction comes from. Numbers are decimal; those
// with a point or exponent are what the machine in double sees, f32 is what they round to.
//
// Tested by: tests/vm/encoding/assemble_test.cpp, tests/golden (assembly)
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <variant>

#include "vm/program/program.h"

namespace fathom::vm {

struct AssembleError {
  std::size_t begin, end;  // bytes of the text at fault
  std::string reason;
  bool unknown_instruction = false;  // those bytes should be a mnemonic
};

// What the text says, sound or not: vm/program/verify.h tells. Without any place (@) in the text there are no debug entries.
[[nodiscard]] std::variant<Program, AssembleError> assemble(std::string_view text);

}  // namespace fathom::vm
