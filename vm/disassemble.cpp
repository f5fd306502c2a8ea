#include "vm/disassemble.h"

#include <fmt/format.h>

#include <bit>

namespace fathom::vm {
namespace {

std::string operation(const Program& program, std::size_t at, const OpcodeInfo& row) {
  std::string text(row.mnemonic);
  if (row.has_operand) text += fmt::format(" {}", operand_of(program.words[at]));
  const std::size_t count = instruction_length(program.words[at]) - 1;
  for (std::size_t n = 0; n < count; ++n) {
    const int i = static_cast<int>(n) % row.immediates;
    if (row.form == Form::Outline && i == 0) text += ' ';  // sets the groups apart
    const std::uint32_t bits = program.words[at + 1 + n];
    text += is_integer_immediate(row, i) ? fmt::format(" {}", bits) : fmt::format(" {}", std::bit_cast<float>(bits));
  }
  return text;
}

std::string place(const Program& program, const DebugEntry& entry) {
  std::string text = entry.symbol;
  if (entry.line > 0) text = fmt::format("{}:{}:{} {}", program.source_name, entry.line, entry.column, text);
  return text;
}

// A stack's height before and after, or the one height when it stays.
std::string height(int before, int change) {
  return change == 0 ? fmt::format("{}", before) : fmt::format("{}->{}", before, before + change);
}

}  // namespace

std::string disassemble(const VerifiedProgram& verified) {
  const Program& program = verified.program();
  std::string text = fmt::format("; {}  {} ops  {} words  max stack {} values, {} points  {} locals  cost {}\n",
                                 program.source_name.empty() ? "program" : program.source_name,
                                 verified.instructions(), program.words.size(), verified.max_values(),
                                 verified.max_points(), program.locals, verified.cost());
  text += "; off  words  values  points  cost  op                               ; source\n";
  int values = 0, points = 1;
  for (std::size_t i = 0, at = 0; at < program.words.size(); ++i) {
    const OpcodeInfo& row = *find_opcode(program.words[at] & 0xff);
    const std::size_t length = instruction_length(program.words[at]);
    const std::string value_stack = height(values, row.effect.values_change);
    const std::string point_stack = height(points, row.effect.points_change);
    values += row.effect.values_change;
    points += row.effect.points_change;
    const std::string source = i < program.debug.size() ? place(program, program.debug[i]) : "";
    text += fmt::format("  {:04}  {:5}  {:>6}  {:>6}  {:4}  {:<32} ; {}\n", at, length, value_stack, point_stack,
                        instruction_cost(program.words[at]), operation(program, at, row), source);
    at += length;
  }
  return text;
}

}  // namespace fathom::vm
