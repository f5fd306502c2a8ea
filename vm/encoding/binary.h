// Programs as bytes; docs/reference/bytecode.md has the layout. Programs are verified when read, and refused with the
// reason. Tested by: tests/vm/encoding/binary_test.cpp
#pragma once

#include <string_view>
#include <variant>

#include "vm/encoding/bytes.h"
#include "vm/encoding/digest.h"
#include "vm/program/verify.h"

namespace fathom::vm {

// Writes the code without debug entries; write_debug() writes these.
void write_program(ByteWriter& out, const VerifiedProgram& program);
[[nodiscard]] std::variant<VerifiedProgram, VerifyError> read_program(ByteReader& in, const Limits& limits = {});

// Source locations of the instructions, and the name of their source.
struct DebugTable {
  std::string source_name;
  std::vector<DebugEntry> entries;  // empty, or one per instruction
};
void write_debug(ByteWriter& out, const VerifiedProgram& program, std::string_view source_name);
// Reads the table of `program`; `in` fails on anything else.
DebugTable read_debug(ByteReader& in, const VerifiedProgram& program);
// Returns a copy of `program` with debug entries `table`.
VerifiedProgram with_debug(const VerifiedProgram& program, DebugTable table);

// Returns a digest of all parts of the opcode table that a program's result depends on. Two builds with the same
// digest compute the same results.
Digest opcode_digest();

}  // namespace fathom::vm
