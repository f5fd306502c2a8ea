// Opcodes and their properties, generated from vm/program/opcodes.def.
// Tested by: tests/vm/program/: opcode_test.cpp, nonexpansive_test.cpp, convexity_test.cpp
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

// Facts about an opcode, in the column `facts` of its row. The forms that a fact is about precede it.
enum class Fact : std::uint16_t {
  None = 0,
  // Point: an affine map, so a function that is convex in the Point's output is also convex in its input.
  Affine = 1 << 0,
  // Point, Shape, Outline: changes faster than its point moves. All other rows have Lipschitz constant 1, |f(p) -
  // f(q)| <= |p - q|, at all finite points, for immediates as the compiler derives them.
  Expansive = 1 << 1,
  // Shape: a convex function of the point for all immediates; its solid is then convex too.
  Convex = 1 << 2,
  // Shape, Outline: the method for the range over a box (vm/range/enclosed-inl.h). Formula: the formula over the box,
  // for rows for which a ball gives no bound or a looser one. Ball: the value at the centre of a ball that contains
  // the points, plus or minus its radius. Both: the intersection of the two. The formula is exact over a box, but a
  // rotated point's box contains more than its ball. Both takes twice as long as Ball, and leaves a fifth to a third
  // fewer of 1000 spheres and boxes in a cell.
  Formula = 1 << 3,
  Ball = 1 << 4,
  Both = Formula | Ball,
  // Shape, Outline: features may be far from the origin even if the surface passes the origin, and the float error
  // grows with the largest immediate. The node table gives these shapes a cancellation (compiler/graph/node_facts.h).
  Far = 1 << 5,
  // Shape: the last immediate is a flag, not a size.
  LastIsFlag = 1 << 6,
  // Outline: has at least three groups.
  ThreeGroups = 1 << 7,
  // Binary: pruning may remove an operand of this choice. Hard: the result always is one of the operands. Smooth: if
  // they differ by at least the row's first immediate.
  Hard = 1 << 8,
  Smooth = 1 << 9,
  // Binary: the operands may be exchanged. The order only decides the sign of a zero, and which NaN is lost.
  Commutes = 1 << 10,
  // Machine: the opcode word's operand is a number.
  Numbered = 1 << 11,
};
constexpr Fact operator|(Fact a, Fact b) {
  return static_cast<Fact>(static_cast<std::uint16_t>(a) | static_cast<std::uint16_t>(b));
}
// True if `facts` has any of `wanted`.
constexpr bool has(Fact facts, Fact wanted) {
  return (static_cast<std::uint16_t>(facts) & static_cast<std::uint16_t>(wanted)) != 0;
}

// Returns the number of values that a function takes; 0 for the other forms.
constexpr int operand_count(Form form) {
  return form == Form::Unary ? 1 : form == Form::Binary ? 2 : form == Form::Ternary ? 3 : 0;
}

// Change of the two stacks' heights by an instruction; *_needed is the height required before the instruction.
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

// True if names of immediates contain an integer's, as "iterations:8" (vm/program/opcodes.def).
constexpr bool has_integers(std::string_view names) { return names.find(':') != std::string_view::npos; }

// Flags in a Shape's operand, which fuse a common sequence into one instruction (compiler/lower/fuse.h).
// kFusedTranslate: three immediates x, y, z precede the row's own, and the shape is translated there. kFusedMin: the
// result is the min of the shape and the top value, and replaces the top value.
inline constexpr std::uint32_t kFusedTranslate = 1, kFusedMin = 2;
// Flags of a template's RoundBox only (vm/prune/program_template.h). kPolymorphic: each lane evaluates a shape of its
// own. kPlaced: an Affine's immediates precede the shape's, and map the point for this shape alone.
inline constexpr std::uint32_t kPolymorphic = 4, kPlaced = 8;
// Source of a Unary's or Binary's operand: the stack, a coordinate of the top point, an immediate before the row's
// own, or a local. A Ternary's operands lie on the stack.
enum class Source : std::uint8_t { Stack, X, Y, Z, Constant, Local };
struct Sources {
  Source a = Source::Stack, b = Source::Stack;  // a Unary has only a
  std::uint32_t local = 0;                      // shared by a and b
};
inline constexpr std::uint32_t kMaxLocalSource = (1u << 18) - 1;

struct OpcodeInfo {
  Opcode opcode;
  std::string_view mnemonic;
  Form form;
  std::string_view immediate_names;  // separated by blanks; ":24" marks an integer from 1 to 24
  int immediates;                    // number of words after the opcode word, in an Outline per group
  Choice choice;
  int cost;  // multiply-adds per point, in an Outline per group
  Fact facts;
  StackEffect effect;  // of the instruction without kFusedTranslate, kFusedMin or Sources
  bool has_operand;    // true if the opcode word's high 24 bits are a number
};

const OpcodeInfo& info(Opcode opcode);

// Returns the number of groups of immediates after an opcode word: an Outline's operand, 1 for any other row.
std::uint32_t group_count(std::uint32_t word);
// Returns the minimum number of groups of an Outline row, 1 for any other row.
std::uint32_t minimum_groups(Opcode opcode);
// Returns the number of immediates before the row's own: 3 for a Shape with kFusedTranslate, 1 per Source::Constant.
int leading_immediates(std::uint32_t word);
StackEffect effect_of(std::uint32_t word);
// True if the result can be exactly one of two operands: a row with a choice, or a Shape with kFusedMin.
bool is_choice(std::uint32_t word);
// Length of an instruction in words, including the opcode word, and its cost in multiply-adds per point. The low byte
// of `word` must name an opcode.
std::size_t instruction_length(std::uint32_t word);
std::uint64_t instruction_cost(std::uint32_t word);

// Returns the row of the opcode `byte`, or nullptr when `byte` names no opcode.
const OpcodeInfo* find_opcode(std::uint32_t byte);

// Returns the maximum of integer immediate `index` of `opcode`, whose minimum is 1, or 0 for a float immediate.
std::uint32_t largest_integer(const OpcodeInfo& opcode, int index);
inline bool is_integer_immediate(const OpcodeInfo& opcode, int index) { return largest_integer(opcode, index) > 0; }
std::string_view immediate_name(const OpcodeInfo& opcode, int index);

// Bound on a Shape's float error per unit of max(1, |p|, |d|), as promised at the head of vm/program/opcodes.def.
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
