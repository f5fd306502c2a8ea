// Programs as bytes: docs/BYTECODE.md has the layout. What is read back is verified, or refused with the reason.
// Tested by: tests/vm/encoding/binary_test.cpp
#pragma once

#include <string_view>
#include <variant>

#include "vm/encoding/bytes.h"
#include "vm/encoding/digest.h"
#include "vm/program/verify.h"

namespace fathom::vm {

// Of the code alone; write_debug() has the rest.
void write_program(ByteWriter& out, const VerifiedProgram& program);
[[nodiscard]] std::variant<VerifiedProgram, VerifyError> read_program(ByteReader& in, const Limits& limits = {});

// Where the instructions come from, and their source's name.
struct DebugTable {
  std::string source_name;
  std::vector<DebugEntry> entries;  // none, or one for each instruction
};
void write_debug(ByteWriter& out, const VerifiedProgram& program, std::string_view source_name);
// `in` fails when there is something else than a table for `program`.
DebugTable read_debug(ByteReader& in, const VerifiedProgram& program);
// The same program with that table.
VerifiedProgram with_debug(const VerifiedProgram& program, DebugTable table);

// Of everything the table of opcodes says that a program's meaning depends on: two builds with the same digest run
// a program alike.
Digest opcode_digest();

}  // namespace fathom::vm
