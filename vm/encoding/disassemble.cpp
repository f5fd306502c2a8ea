#include "vm/encoding/disassemble.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "vm/encoding/escape.h"
#include "vm/encoding/repeats.h"

namespace fathom::vm {
namespace {

// Minimum number of rows that a listing writes as rows.
constexpr std::size_t kLeastListedRows = 16;
// Number of rows at either end of a block that a short listing shows.
constexpr std::size_t kShownRows = 2;

// Returns the text of the float immediate at an offset.
using NumberText = std::function<std::string(std::size_t word)>;

// Returns the operands' text, e.g. " _ x", or "" when all operands come from the stack. `constant`: offset of the
// first leading immediate.
std::string operands(const OpcodeInfo& row, std::uint32_t word, std::size_t constant, const NumberText& number) {
  if ((row.form != Form::Unary && row.form != Form::Binary) || operand_of(word) == 0) return "";
  const Sources sources = sources_of(word);
  const auto name = [&](Source source) -> std::string {
    if (source == Source::Constant) return " " + number(constant++);
    if (source == Source::Local) return fmt::format(" %{}", sources.local);
    return std::string(" ") + "_xyz"[static_cast<std::size_t>(source)];
  };
  std::string text = name(sources.a);
  if (row.form == Form::Binary) text += name(sources.b);
  return text;
}

// Returns the text of kFusedTranslate and kFusedMin, e.g. " at 0 1 0 min". `moved`: offset of the translation.
std::string shape_modes(const OpcodeInfo& row, std::uint32_t word, std::size_t moved, const NumberText& number) {
  if (row.form != Form::Shape) return "";
  std::string text;
  if (operand_of(word) & kFusedTranslate) {
    text = " at";
    for (std::size_t i = 0; i < 3; ++i) text += " " + number(moved + i);
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

std::string text_of(const Program& program, std::size_t at, const NumberText& number) {
  const OpcodeInfo& row = *find_opcode(program.words[at] & 0xff);
  const std::uint32_t word = program.words[at];
  std::string text(row.mnemonic);
  if (row.has_operand) text += fmt::format(" {}", operand_of(word));
  text += operands(row, word, at + 1, number);
  const auto leading = static_cast<std::size_t>(leading_immediates(word));
  const std::size_t first = at + 1 + leading, count = instruction_length(word) - 1 - leading;
  for (std::size_t n = 0; n < count; ++n) {
    const int i = static_cast<int>(n) % row.immediates;
    if (row.form == Form::Outline && i == 0) text += ' ';  // separates the groups
    text += is_integer_immediate(row, i) ? fmt::format(" {}", program.words[first + n]) : " " + number(first + n);
  }
  return text + shape_modes(row, word, at + 1, number);
}

class Disassembler {
 public:
  Disassembler(const VerifiedProgram& verified, const ListedRows& rows)
      : verified_(verified), program_(verified.program()), rows_(rows), offsets_(offsets_of(program_)) {}

  std::string run() {
    text_ = fmt::format("; {} ops  {} words  max stack {} values, {} points  {} locals  cost {}\n",
                        verified_.instructions(), program_.words.size(), verified_.max_values(),
                        verified_.max_points(), program_.locals, verified_.cost());
    if (program_.locals > 0) text_ += fmt::format("locals {}\n", program_.locals);
    if (!program_.source_name.empty()) text_ += fmt::format("source {}\n", quote(program_.source_name));
    text_ += "; off  words  values  points  cost  op                                       ; source\n";
    for (const Repeat& block : blocks()) {
      if (block.rows == 1) {
        for (const std::size_t end = next_ + block.length; next_ < end;) add_line({});
      } else {
        add_rows(block);
      }
    }
    return std::move(text_);
  }

 private:
  // Instructions are alike if their places are, too.
  std::vector<Repeat> blocks() const {
    if (rows_.unrolled) return {{offsets_.size(), 1}};
    std::vector<std::uint64_t> keys = code_keys(program_, offsets_);
    std::vector<const DebugEntry*> different;
    const std::vector<std::uint64_t> places = debug_keys(program_.debug, different);
    std::map<std::pair<std::uint64_t, std::uint64_t>, std::uint64_t> known;
    for (std::size_t i = 0; i < places.size(); ++i)
      keys[i] = known.try_emplace({keys[i], places[i]}, known.size()).first->second;
    return find_repeats(keys, kLeastListedRows);
  }

  // Adds the next instruction. `varying`: offsets of immediates that rows give.
  void add_line(const std::set<std::size_t>& varying) {
    const std::size_t at = offsets_[next_], length = instruction_length(program_.words[at]);
    const StackEffect effect = effect_of(program_.words[at]);
    const std::string value_stack = height(values_, effect.values_change);
    const std::string point_stack = height(points_, effect.points_change);
    values_ += effect.values_change;
    points_ += effect.points_change;
    const std::string line =
        fmt::format("  {:04}  {:5}  {:>6}  {:>6}  {:4}  {:<40} ", at, length, value_stack, point_stack,
                    instruction_cost(program_.words[at]), text_of(program_, at, [&](std::size_t word) -> std::string {
                      return varying.contains(word) ? "#" : fmt::format("{}", program_.doubles[word]);
                    }));
    text_ += next_ < program_.debug.size() ? line + place(program_.debug[next_]) + '\n' : trimmed(line) + '\n';
    ++next_;
  }

  void add_rows(const Repeat& block) {
    const std::size_t first = offsets_[next_],
                      stride = offsets_[next_ + block.length] - first;  // a block of several rows has a next row
    const std::vector<std::size_t> varying = varying_of(block, stride);
    text_ += fmt::format("each {}\n", block.rows);
    const std::size_t after = next_ + block.length * block.rows;
    const int values = values_, points = points_;
    for (std::size_t i = 0; i < block.length; ++i) add_line({varying.begin(), varying.end()});
    const auto rows = static_cast<int>(block.rows);
    values_ = values + rows * (values_ - values), points_ = points + rows * (points_ - points);
    next_ = after;
    text_ += "rows\n";
    bool left_out = false;
    for (std::size_t row = 0; row < block.rows && !varying.empty(); ++row) {
      const std::size_t number = first_row_ + row;
      const bool few = row < kShownRows || row + kShownRows >= block.rows;
      if (rows_.range ? number < rows_.range->first || number >= rows_.range->second : rows_.few && !few) {
        if (!left_out) text_ += "  ...\n";
        left_out = true;
        continue;
      }
      left_out = false;
      text_ += ' ';
      for (const std::size_t word : varying) text_ += fmt::format(" {}", program_.doubles[word + row * stride]);
      text_ += '\n';
    }
    first_row_ += block.rows;
    text_ += "end\n";
  }

  // Returns the offsets of the immediates that rows give, in the order of the text.
  std::vector<std::size_t> varying_of(const Repeat& block, std::size_t stride) const {
    const std::vector<std::size_t> differ = varying_words(program_, offsets_[next_], stride, block.rows);
    std::vector<std::size_t> varying;
    for (std::size_t i = 0; i < block.length; ++i) {
      text_of(program_, offsets_[next_ + i], [&](std::size_t word) -> std::string {
        if (std::ranges::binary_search(differ, word)) varying.push_back(word);
        return "";
      });
    }
    return varying;
  }

  const VerifiedProgram& verified_;
  const Program& program_;
  const ListedRows& rows_;
  const std::vector<std::size_t> offsets_;
  std::size_t next_ = 0;       // instruction
  std::size_t first_row_ = 0;  // number of the next block's first row
  int values_ = 0, points_ = 1;
  std::string text_;
};

}  // namespace

std::string instruction_text(const Program& program, std::size_t at) {
  return text_of(program, at, [&](std::size_t word) { return fmt::format("{}", program.doubles[word]); });
}

std::string disassemble(const VerifiedProgram& program, const ListedRows& rows) {
  return Disassembler(program, rows).run();
}

}  // namespace fathom::vm
