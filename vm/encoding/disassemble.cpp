#include "vm/encoding/disassemble.h"

#include <fmt/format.h>

#include "vm/encoding/escape.h"

namespace fathom::vm {
namespace {

// Returns the operands' text, e.g. " _ x", or "" when all operands come from the stack. `constant`: offset of the
// first leading immediate.
std::string operands(const Program& program, const OpcodeInfo& row, std::uint32_t word, std::size_t constant) {
  if ((row.form != Form::Unary && row.form != Form::Binary) || operand_of(word) == 0) return "";
  const Sources sources = sources_of(word);
  const auto name = [&](Source source) -> std::string {
    if (source == Source::Constant) return fmt::format(" {}", program.doubles[constant++]);
    if (source == Source::Local) return fmt::format(" %{}", sources.local);
    return std::string(" ") + "_xyz"[static_cast<std::size_t>(source)];
  };
  std::string text = name(sources.a);
  if (row.form == Form::Binary) text += name(sources.b);
  return text;
}

// Returns the text of kFusedTranslate and kFusedMin, e.g. " at 0 1 0 min". `moved`: offset of the translation.
std::string shape_modes(const Program& program, const OpcodeInfo& row, std::uint32_t word, std::size_t moved) {
  if (row.form != Form::Shape) return "";
  std::string text;
  if (operand_of(word) & kFusedTranslate) {
    text =
        fmt::format(" at {} {} {}", program.doubles[moved], program.doubles[moved + 1], program.doubles[moved + 2]);
  }
  return operand_of(word) & kFusedMin ? text + " min" : text;
}

std::string place(const DebugEntry& entry) {
  const std::string where = entry.line > 0 ? fmt::format("@{}:{}", entry.line, entry.column) : "@";
  return entry.symbol.empty() ? where : where + " " + escape(entry.symbol);
}

// Returns a stack's height before and after, e.g. "0->1", or one number when the height does not change.
std::string height(int before, int change) {
  return change == 0 ? fmt::format("{}", before) : fmt::format("{}->{}", before, before + change);
}

std::string trimmed(std::string text) {
  text.erase(text.find_last_not_of(' ') + 1);
  return text;
}

}  // namespace

std::string instruction_text(const Program& program, std::size_t at) {
  const OpcodeInfo& row = *find_opcode(program.words[at] & 0xff);
  const std::uint32_t word = program.words[at];
  std::string text(row.mnemonic);
  if (row.has_operand) text += fmt::format(" {}", operand_of(word));
  text += operands(program, row, word, at + 1);
  const auto leading = static_cast<std::size_t>(leading_immediates(word));
  const std::size_t first = at + 1 + leading, count = instruction_length(word) - 1 - leading;
  for (std::size_t n = 0; n < count; ++n) {
    const int i = static_cast<int>(n) % row.immediates;
    if (row.form == Form::Outline && i == 0) text += ' ';  // separates the groups
    text += is_integer_immediate(row, i) ? fmt::format(" {}", program.words[first + n])
                                         : fmt::format(" {}", program.doubles[first + n]);
  }
  return text + shape_modes(program, row, word, at + 1);
}

std::string disassemble(const VerifiedProgram& verified) {
  const Program& program = verified.program();
  std::string text = fmt::format("; {} ops  {} words  max stack {} values, {} points  {} locals  cost {}\n",
                                 verified.instructions(), program.words.size(), verified.max_values(),
                                 verified.max_points(), program.locals, verified.cost());
  if (program.locals > 0) text += fmt::format("locals {}\n", program.locals);
  if (!program.source_name.empty()) text += fmt::format("source {}\n", quote(program.source_name));
  text += "; off  words  values  points  cost  op                                       ; source\n";
  int values = 0, points = 1;
  for (std::size_t i = 0, at = 0; at < program.words.size(); ++i) {
    const std::size_t length = instruction_length(program.words[at]);
    const StackEffect effect = effect_of(program.words[at]);
    const std::string value_stack = height(values, effect.values_change);
    const std::string point_stack = height(points, effect.points_change);
    values += effect.values_change;
    points += effect.points_change;
    const std::string line =
        fmt::format("  {:04}  {:5}  {:>6}  {:>6}  {:4}  {:<40} ", at, length, value_stack, point_stack,
                    instruction_cost(program.words[at]), instruction_text(program, at));
    text += i < program.debug.size() ? line + place(program.debug[i]) + '\n' : trimmed(line) + '\n';
    at += length;
  }
  return text;
}

}  // namespace fathom::vm
