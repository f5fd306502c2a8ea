// Opcodes and what is known of each, generated from vm/program/opcodes.def.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace fathom::vm {

enum class Opcode : std::uint8_t {
#define OP(Name, ...) Name,
#include "vm/program/opcodes.def"
#undef OP
};

inline constexpr int kOpcodeCount = 0
#define OP(...) +1
#include "vm/program/opcodes.def"
#undef OP
    ;

enum class Form : std::uint8_t { Point, Shape, Outline, Unary, Binary, Ternary, Machine };
enum class Choice : std::uint8_t { None, Lesser, Greater, Carve, Either };

// How an instruction changes the heights of the two stacks. `needs` is the height that must be there before.
struct StackEffect {
  int values_needed, values_change;
  int points_needed, points_change;
};

// Counts blank-separated names.
constexpr int count_names(std::string_view names) {
  int count = 0;
  bool inside = false;
  for (char c : names) {
    if (c != ' ' && !inside) ++count;
    inside = c != ' ';
  }
  return count;
}

// What the operand of an instruction says beside its row, so that what is often done together is one instruction
// (compiler/lower/fuse.h). A Shape can be moved: three immediates x, y, z come before its own, and it stands there. It can
// be joined: the result is the least of it and the top value, which it replaces.
inline constexpr std::uint32_t kMoved = 1, kJoined = 2;
// Of skeletons' round boxes alone (vm/prune/skeleton.h): it is another shape in every lane.
inline constexpr std::uint32_t kAnyShape = 4;
// A Unary's or Binary's operand can come from elsewhere than the stack: a coordinate of the top point, an immediate
// before the row's own, or a local. Those of a Ternary lie on the stack.
enum class Source : std::uint8_t { Stack, X, Y, Z, Constant, Local };
struct Sources {
  Source a = Source::Stack, b = Source::Stack;  // a Unary has a alone
  std::uint32_t local = 0;                      // the same of both
};
inline constexpr std::uint32_t kMaxLocalSource = (1u << 18) - 1;

struct OpcodeInfo {
  Opcode opcode;
  std::string_view mnemonic;
  Form form;
  std::string_view immediate_names;  // blank separated, ":24" marks a whole number from 1 to 24
  int immediates;                    // words after the opcode word; of an Outline, of one group
  Choice choice;
  int cost;            // multiply-adds per point; of an Outline, of one group
  StackEffect effect;  // of the plain instruction
  bool has_operand;    // the opcode word's high 24 bits are a number
};

const OpcodeInfo& info(Opcode opcode);

// The groups of immediates after an opcode word: an Outline's operand, 1 of any other row.
std::uint32_t group_count(std::uint32_t word);
// The least count an Outline row allows; 1 of any other row.
std::uint32_t minimum_groups(Opcode opcode);
// Immediates before the row's own: where a Shape is moved to, a Source::Constant of a and of b.
int leading_immediates(std::uint32_t word);
StackEffect effect_of(std::uint32_t word);
// Whether the result can be exactly one of two operands: a row with a choice, or a joined Shape.
bool is_choice(std::uint32_t word);
// Words of an instruction, the opcode word included, and its cost. The low byte must name an opcode.
std::size_t instruction_length(std::uint32_t word);
std::uint64_t instruction_cost(std::uint32_t word);

// The i-th row, or nullptr when `byte` names no opcode.
const OpcodeInfo* find_opcode(std::uint32_t byte);

// The most that immediate `index` of `opcode` can be, an unsigned integer from 1; 0 when it is a float.
std::uint32_t largest_integer(const OpcodeInfo& opcode, int index);
inline bool is_integer_immediate(const OpcodeInfo& opcode, int index) { return largest_integer(opcode, index) > 0; }
std::string_view immediate_name(const OpcodeInfo& opcode, int index);

// What the head of vm/program/opcodes.def promises of a Shape's float error, per unit of max(1, |p|, |d|).
inline constexpr double kFloatError = 10 * 0x1p-24;

inline constexpr std::uint32_t opcode_word(Opcode opcode, std::uint32_t operand = 0) {
  return static_cast<std::uint32_t>(opcode) | operand << 8;
}
inline constexpr std::uint32_t operand_of(std::uint32_t word) { return word >> 8; }
inline constexpr std::uint32_t kMaxOperand = (1u << 24) - 1;

inline constexpr std::uint32_t operand_of(const Sources& sources) {
  return static_cast<std::uint32_t>(sources.a) | static_cast<std::uint32_t>(sources.b) << 3 | sources.local << 6;
}
inline constexpr Sources sources_of(std::uint32_t word) {
  const std::uint32_t operand = operand_of(word);
  return {static_cast<Source>(operand & 7), static_cast<Source>(operand >> 3 & 7), operand >> 6};
}

}  // namespace fathom::vm
