// Programs as bytes; docs/reference/bytecode.md has the layout. Programs are verified when read, and refused with the
// reason. Tested by: tests/vm/encoding/binary_test.cpp
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <variant>
#include <vector>

#include "vm/encoding/bytes.h"
#include "vm/encoding/digest.h"
#include "vm/program/verify.h"

namespace fathom::vm {

// The instructions of all programs before the one that is written or read.
class InstructionHistory {
 public:
  struct Stretch {
    std::size_t first = 0, length = 0;  // instructions
  };
  Stretch find(const Program& program, std::span<const std::size_t> places, std::size_t first) const;
  void add(const Program& program);
  bool append(const Stretch& stretch, std::size_t most, Program& program) const;

 private:
  static std::uint64_t hash_of(const Program& program, std::size_t at);

  std::vector<std::uint32_t> words_;
  std::vector<double> doubles_;
  std::vector<std::size_t> places_;                       // [instruction] offset in words_
  std::unordered_map<std::uint64_t, std::size_t> first_;  // hash of some instructions -> the first such place
};

// Writes programs one after another, without debug entries; write_debug() writes these. A body of instructions that
// repeats is written once, with a column for each of its immediates, and a stretch that an earlier program has, too,
// as its place there.
class ProgramEncoder {
 public:
  void write(ByteWriter& out, const VerifiedProgram& program);

 private:
  friend class ProgramDecoder;  // has the history of what it writes again
  void write_blocks(ByteWriter& out, const Program& program, std::span<const std::size_t> places);
  void write_column(ByteWriter& out, std::vector<std::uint64_t> column);

  InstructionHistory history_;
  std::map<std::vector<std::uint64_t>, std::uint32_t> columns_;  // of the block: bits of each row's number -> number
};

// Reads what ProgramEncoder wrote. Refuses other forms of the same programs.
class ProgramDecoder {
 public:
  [[nodiscard]] std::variant<VerifiedProgram, VerifyError> read(ByteReader& in, const Limits& limits = {});

 private:
  std::vector<double> read_column(ByteReader& in, std::size_t rows);
  std::string read_block(ByteReader& in, std::size_t most, Program& program);

  std::vector<std::vector<double>> columns_;  // of the block
  ProgramEncoder encoder_;
};

// Source locations of the instructions, and the name of their source.
struct DebugTable {
  std::string source_name;
  std::vector<DebugEntry> entries;  // empty, or one per instruction
};
void write_debug(ByteWriter& out, const DebugTable& table);
// Reads the table of `program`; `in` fails on anything else than write_debug() writes.
DebugTable read_debug(ByteReader& in, const VerifiedProgram& program);
// Returns a copy of `program` with debug entries `table`.
VerifiedProgram with_debug(const VerifiedProgram& program, DebugTable table);

// Returns a digest of all parts of the opcode table that a program's result depends on. Two builds with the same
// digest compute the same results.
Digest opcode_digest();

}  // namespace fathom::vm
