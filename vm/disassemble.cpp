#include "vm/disassemble.h"

#include <fmt/format.h>

#include <bit>

namespace fathom::vm {
namespace {

std::string operation(const Program& program, std::size_t at, const OpcodeInfo& row) {
  std::string text(row.mnemonic);
  if (row.has_operand) text += fmt::format(" {}", operand_of(program.words[at]));
  for (int i = 0; i < row.immediates; ++i) {
    const std::uint32_t bits = program.words[at + 1 + static_cast<std::size_t>(i)];
    text += is_integer_immediate(row, i) ? fmt::format(" {}", bits) : fmt::format(" {}", std::bit_cast<float>(bits));
  }
  return text;
}

std::string place(const Program& program, const DebugEntry& entry) {
  std::string text = entry.symbol;
  if (entry.line > 0) text = fmt::format("{}:{}:{} {}", program.source_name, entry.line, entry.column, text);
  return text;
}

}  // namespace

std::string disassemble(const VerifiedProgram& verified) {
  const Program& program = verified.program();
  std::string text = fmt::format("; {}  {} ops  {} words  max stack {} values, {} points  {} locals  cost {}\n",
                                 program.source_name.empty() ? "program" : program.source_name, verified.instructions(),
                                 program.words.size(), verified.max_values(), verified.max_points(), program.locals,
                                 verified.cost());
  text += "; off  words  stack  cost  op                               ; source\n";
  int values = 0, points = 1;
  for (std::size_t i = 0, at = 0; at < program.words.size(); ++i) {
    const OpcodeInfo& row = *find_opcode(program.words[at] & 0xff);
    values += row.effect.values_change;
    points += row.effect.points_change;
    const std::string stack = fmt::format("{}/{}", values, points);
    const std::string source = i < program.debug.size() ? place(program, program.debug[i]) : "";
    text += fmt::format("  {:04}  {:5}  {:>5}  {:4}  {:<32} ; {}\n", at, 1 + row.immediates, stack, row.cost,
                        operation(program, at, row), source);
    at += 1 + static_cast<std::size_t>(row.immediates);
  }
  return text;
}

}  // namespace fathom::vm
