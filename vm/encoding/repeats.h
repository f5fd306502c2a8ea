// Repeats in programs: bodies of instructions that follow one another many times. A union of a thousand balls is a
// thousand times the same instructions with other numbers, and files and listings write the instructions once.
// Tested by: tests/vm/encoding/repeats_test.cpp
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "vm/program/program.h"

namespace fathom::vm {

// Limits on what the few bytes of rows may ask for: words per instruction of a program, which most programs stay
// below, and bytes of the symbols in debug entries.
inline constexpr std::size_t kWordsPerInstruction = 16, kMostRowSymbols = 128 << 20;

// `rows` times a body of `length` instructions. A block without a repeat has one row.
struct Repeat {
  std::size_t length, rows;
};

// Returns blocks that together are a sequence of instructions. Instructions are alike if their keys are equal. A
// repeat has at least `least_rows` rows.
std::vector<Repeat> find_repeats(std::span<const std::uint64_t> keys, std::size_t least_rows);

// Returns the offsets of the program's instructions, in words.
std::vector<std::size_t> offsets_of(const Program& program);

// Returns keys of the instructions at these offsets, equal if they differ in float immediates alone.
std::vector<std::uint64_t> code_keys(const Program& program, std::span<const std::size_t> offsets);

// Returns keys of debug entries, equal if line, column and symbol are: indices into `different`.
std::vector<std::uint64_t> debug_keys(std::span<const DebugEntry> entries, std::vector<const DebugEntry*>& different);

// Returns the offsets of the words of a body whose doubles are not the same in all rows. The first row begins at
// `begin`, each `stride` words after the one before.
std::vector<std::size_t> varying_words(const Program& program, std::size_t begin, std::size_t stride,
                                       std::size_t rows);

// Calls body(word, is_float) for the offsets of the immediates of the instruction with this opcode word at `offset`.
template <typename Body>
void for_each_immediate(std::uint32_t opcode_word, std::size_t offset, const Body& body) {
  const OpcodeInfo& row = *find_opcode(opcode_word & 0xff);
  const std::size_t end = offset + instruction_length(opcode_word);
  const std::size_t own = offset + 1 + static_cast<std::size_t>(leading_immediates(opcode_word));
  for (std::size_t word = offset + 1; word < end; ++word)
    body(word, word < own || !is_integer_immediate(row, static_cast<int>(word - own) % row.immediates));
}

}  // namespace fathom::vm
