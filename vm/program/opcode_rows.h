// Inline copy of columns of the opcode table (vm/program/opcode.h). The evaluators need facts at compile time.
// Reading and pruning programs takes hundreds of thousands of lookups per image, and a function call per lookup took
// half of the time.
// Tested by: tests/vm/program/opcode_test.cpp
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "vm/program/opcode.h"

namespace fathom::vm {

struct OpcodeRow {
  Opcode opcode;
  Form form;
  Choice choice;
  Fact facts;
  int immediates;     // as OpcodeInfo::immediates
  int cost;           // as OpcodeInfo::cost
  bool has_integers;  // true if integers are among the immediates
};

inline constexpr auto kOpcodeRows = [] {
  using enum Fact;
  return std::array<OpcodeRow, kOpcodeCount>{{
#define OP(Name, mnemonic, form, immediates, choice, cost, facts, meaning) \
  {Opcode::Name, Form::form, Choice::choice, facts, count_names(immediates), cost, has_integers(immediates)},
#include "vm/program/opcodes.def"
#undef OP
  }};
}();

constexpr bool has(Opcode opcode, Fact wanted) {
  return has(kOpcodeRows[static_cast<std::size_t>(opcode)].facts, wanted);
}

constexpr const OpcodeRow& row_of(std::uint32_t word) { return kOpcodeRows[word & 0xff]; }

inline bool is_function(Form form) { return form == Form::Unary || form == Form::Binary; }
inline bool is_joined(std::uint32_t word) {
  return row_of(word).form == Form::Shape && (operand_of(word) & kFusedMin) != 0;
}

// Returns the number of words of an instruction after its opcode word.
inline std::uint32_t immediates_of(std::uint32_t word) {
  const OpcodeRow& row = row_of(word);
  const auto own = static_cast<std::uint32_t>(row.immediates);
  if (is_function(row.form)) {
    const Sources sources = sources_of(word);
    return own + (sources.a == Source::Constant) + (sources.b == Source::Constant);
  }
  if (row.form == Form::Shape) return own + (operand_of(word) & kFusedTranslate ? 3 : 0);
  return row.form == Form::Outline ? own * operand_of(word) : own;
}

}  // namespace fathom::vm
