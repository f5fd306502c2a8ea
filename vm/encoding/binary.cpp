#include "vm/encoding/binary.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <span>
#include <utility>
#include <vector>

#include "vm/encoding/repeats.h"

namespace fathom::vm {
namespace {

// Version of the opcodes' results. Increase the number whenever a function of vm/interpret/*-inl.h or vm/number/
// changes its values, because kRows does not show that. tests/vm/encoding/binary_test.cpp fails when this was
// forgotten.
constexpr std::string_view kMachine = "fathom machine 1\n";

// Columns of the opcode table that a program's result depends on. The cost is an estimate, and the facts follow from
// the meaning.
constexpr std::string_view kRows =
#define OP(Name, mnemonic, form, immediates, choice, cost, facts, meaning) \
  mnemonic " " #form " " immediates " " #choice " " #meaning "\n"
#include "vm/program/opcodes.def"
#undef OP
    ;

// The kinds of columns. A column holds a float immediate of each row of a block: one number for all rows or a number
// for each, as f32 where that is exact, or what an earlier column of the block holds.
enum class ColumnKind : std::uint8_t { One32, One64, Each32, Each64, Same };

// Minimum number of rows that are worth a block.
constexpr std::size_t kLeastStoredRows = 4;
// Minimum size of a stretch that is worth a copy.
constexpr std::size_t kLeastCopy = 2, kLeastWords = 12;

std::uint64_t bits_of(double value) { return std::bit_cast<std::uint64_t>(value); }
float rounded(std::uint64_t bits) { return static_cast<float>(std::bit_cast<double>(bits)); }
bool fits_float(std::uint64_t bits) { return bits_of(static_cast<double>(rounded(bits))) == bits; }

// `bits`: of a double.
void write_number(ByteWriter& out, std::uint64_t bits, bool narrow) {
  if (narrow) return out.u32(std::bit_cast<std::uint32_t>(rounded(bits)));
  out.u64(bits);
}
double read_number(ByteReader& in, bool narrow) {
  return narrow ? static_cast<double>(std::bit_cast<float>(in.u32())) : in.f64();
}

}  // namespace

// Finds the longest stretch of earlier programs that equals `program` from instruction `first` on.
InstructionHistory::Stretch InstructionHistory::find(const Program& program, std::span<const std::size_t> places,
                                                     std::size_t first) const {
  if (first + kLeastCopy > places.size()) return {};
  const auto found = first_.find(hash_of(program, places[first]));
  if (found == first_.end()) return {};
  Stretch stretch{found->second, 0};
  const auto equal = [&](std::size_t from, std::size_t at, std::size_t size) {
    return std::equal(&program.words[at], &program.words[at] + size, &words_[from]) &&
           std::equal(&program.doubles[at], &program.doubles[at] + size, &doubles_[from],
                      [](double x, double y) { return bits_of(x) == bits_of(y); });
  };
  std::size_t words = 0;
  for (std::size_t i = first, j = stretch.first; i < places.size() && j < places_.size();
       ++i, ++j, ++stretch.length) {
    const std::size_t size = instruction_length(program.words[places[i]]);
    if (size != instruction_length(words_[places_[j]]) || !equal(places_[j], places[i], size)) break;
    words += size;
  }
  return words < kLeastWords ? Stretch{} : stretch;
}

// Returns a number made of kLeastCopy instructions from the word `at` on.
std::uint64_t InstructionHistory::hash_of(const Program& program, std::size_t at) {
  std::uint64_t hash = 0;
  const auto mix = [&hash](std::uint64_t word) { hash = (std::rotl(hash, 23) ^ word) * 0x9E3779B97F4A7C15u; };
  for (std::size_t i = 0; i < kLeastCopy; ++i) {
    const std::size_t end = at + instruction_length(program.words[at]);
    for (; at < end; ++at) mix(program.words[at]), mix(bits_of(program.doubles[at]));
  }
  return hash;
}

void InstructionHistory::add(const Program& program) {
  const std::vector<std::size_t> places = offsets_of(program);
  for (std::size_t i = 0; i + kLeastCopy <= places.size(); ++i)
    first_.try_emplace(hash_of(program, places[i]), places_.size() + i);
  for (const std::size_t at : places) places_.push_back(words_.size() + at);
  words_.insert(words_.end(), program.words.begin(), program.words.end());
  doubles_.insert(doubles_.end(), program.doubles.begin(), program.doubles.end());
}

// Appends a stretch, which has at most `most` words, to `program`. Returns false if there is no such stretch.
bool InstructionHistory::append(const Stretch& stretch, std::size_t most, Program& program) const {
  if (stretch.length == 0 || stretch.first > places_.size() || stretch.length > places_.size() - stretch.first)
    return false;
  const std::size_t last = stretch.first + stretch.length, begin = places_[stretch.first],
                    end = last < places_.size() ? places_[last] : words_.size();
  if (end - begin > most) return false;
  const auto copy = [&](const auto& from, auto& to) {
    to.insert(to.end(), from.begin() + static_cast<std::ptrdiff_t>(begin),
              from.begin() + static_cast<std::ptrdiff_t>(end));
  };
  copy(words_, program.words);
  copy(doubles_, program.doubles);
  return true;
}

void ProgramEncoder::write(ByteWriter& out, const VerifiedProgram& verified) {
  const Program& program = verified.program();
  out.u32(program.locals);
  out.u32(verified.max_values());
  out.u32(verified.max_points());
  out.u32(static_cast<std::uint32_t>(program.words.size()));
  const std::vector<std::size_t> all = offsets_of(program);
  const std::span<const std::size_t> places = all;
  std::size_t fresh = 0;  // the first instruction that is not yet written
  for (std::size_t i = 0; i < places.size();) {
    const InstructionHistory::Stretch stretch = history_.find(program, places, i);
    if (stretch.length == 0) {
      ++i;
      continue;
    }
    write_blocks(out, program, places.subspan(fresh, i - fresh));
    out.u32(static_cast<std::uint32_t>(stretch.length));
    out.u32(0);
    out.u32(static_cast<std::uint32_t>(stretch.first));
    fresh = i += stretch.length;
  }
  write_blocks(out, program, places.subspan(fresh));
  history_.add(program);
}

// Writes instructions as bodies and their rows.
void ProgramEncoder::write_blocks(ByteWriter& out, const Program& program, std::span<const std::size_t> places) {
  for (const Repeat& block : find_repeats(code_keys(program, places), kLeastStoredRows)) {
    out.u32(static_cast<std::uint32_t>(block.length));
    out.u32(static_cast<std::uint32_t>(block.rows));
    columns_.clear();
    for (std::size_t i = 0; i < block.length; ++i) {
      const std::size_t at = places[i];
      out.u32(program.words[at]);
      for_each_immediate(program.words[at], at, [&](std::size_t word, bool is_float) {
        if (!is_float) return out.u32(program.words[word]);
        std::vector<std::uint64_t> column;
        for (std::size_t row = 0; row < block.rows; ++row)
          column.push_back(bits_of(program.doubles[places[row * block.length + i] + word - at]));
        write_column(out, std::move(column));
      });
    }
    places = places.subspan(block.length * block.rows);
  }
}

// `column`: bits of doubles.
void ProgramEncoder::write_column(ByteWriter& out, std::vector<std::uint64_t> column) {
  const auto kind = [&out](ColumnKind is) { out.u8(static_cast<std::uint8_t>(is)); };
  const bool narrow = std::ranges::all_of(column, fits_float);
  if (std::ranges::count(column, column[0]) == std::ssize(column)) {
    kind(narrow ? ColumnKind::One32 : ColumnKind::One64);
    return write_number(out, column[0], narrow);
  }
  const auto [same, is_new] = columns_.try_emplace(column, static_cast<std::uint32_t>(columns_.size()));
  if (!is_new) {
    kind(ColumnKind::Same);
    return out.u32(same->second);
  }
  kind(narrow ? ColumnKind::Each32 : ColumnKind::Each64);
  for (const std::uint64_t value : column) write_number(out, value, narrow);
}

// Reads the numbers of a column: one, or one for each row.
std::vector<double> ProgramDecoder::read_column(ByteReader& in, std::size_t rows) {
  const std::uint8_t byte = in.u8();
  const auto kind = static_cast<ColumnKind>(byte);
  const bool narrow = kind == ColumnKind::One32 || kind == ColumnKind::Each32;
  if (kind == ColumnKind::One32 || kind == ColumnKind::One64) return {read_number(in, narrow)};
  if (kind == ColumnKind::Same) {
    const std::uint32_t number = in.u32();
    if (number < columns_.size()) return columns_[number];
  } else if (byte < static_cast<std::uint8_t>(ColumnKind::Same) && rows <= in.left() / (narrow ? 4 : 8)) {
    std::vector<double> column(rows);
    for (double& value : column) value = read_number(in, narrow);
    columns_.push_back(column);
    return column;
  }
  in.fail();
  return {0};
}

// Appends the rows of a block, which fit in `most` words. Returns an empty text, or what is wrong with the block.
std::string ProgramDecoder::read_block(ByteReader& in, std::size_t most, Program& program) {
  const std::size_t length = in.u32(), rows = in.u32();
  const std::string nonsense = "a block of instructions that makes no sense";
  if (rows == 0) return encoder_.history_.append({in.u32(), length}, most, program) ? "" : nonsense;
  std::vector<std::uint32_t> body;
  columns_.clear();
  std::vector<std::pair<std::size_t, std::vector<double>>> columns;  // by the word in the body
  for (std::size_t i = 0; i < length; ++i) {
    const std::uint32_t opcode = in.u32();
    if (in.failed()) return nonsense;
    if (find_opcode(opcode & 0xff) == nullptr) return fmt::format("no opcode {}", opcode & 0xff);
    const std::size_t at = body.size(), size = instruction_length(opcode);
    if (size - 1 > in.left() || at + size > most / rows) return nonsense;
    body.resize(at + size);
    body[at] = opcode;
    for_each_immediate(opcode, at, [&](std::size_t word, bool is_float) {
      if (is_float) {
        columns.emplace_back(word, read_column(in, rows));
      } else {
        body[word] = in.u32();
      }
    });
  }
  if (in.failed() || body.empty()) return nonsense;
  for (std::size_t row = 0; row < rows; ++row) {
    const std::size_t begin = program.words.size();
    program.words.insert(program.words.end(), body.begin(), body.end());
    program.doubles.resize(program.words.size());
    for (const auto& [word, values] : columns) {
      const double value = values[values.size() == 1 ? 0 : row];
      program.doubles[begin + word] = value;
      program.words[begin + word] = std::bit_cast<std::uint32_t>(static_cast<float>(value));
    }
  }
  return "";
}

std::variant<VerifiedProgram, VerifyError> ProgramDecoder::read(ByteReader& in, const Limits& limits) {
  const ByteReader whole = in;
  Program program;
  program.locals = in.u32();
  const std::uint32_t max_values = in.u32(), max_points = in.u32(), size = in.u32();
  if (size > limits.words) return VerifyError{0, fmt::format("{} words; at most {} are allowed", size, limits.words)};
  while (program.words.size() < size && !in.failed()) {
    const auto at = static_cast<std::uint32_t>(program.words.size());
    std::string problem = read_block(in, size - at, program);
    if (!problem.empty() && !in.failed()) return VerifyError{at, std::move(problem)};
  }
  if (in.failed()) return VerifyError{0, "the program is cut off"};
  auto verified = verify(std::move(program), limits);
  const auto* good = std::get_if<VerifiedProgram>(&verified);
  if (good == nullptr) return verified;
  if (good->max_values() != max_values || good->max_points() != max_points) {
    return VerifyError{0, fmt::format("declares stacks of {} values and {} points; the code reaches {} and {}",
                                      max_values, max_points, good->max_values(), good->max_points())};
  }
  ByteWriter again;
  encoder_.write(again, *good);
  ByteReader read = whole;
  if (!std::ranges::equal(again.bytes(), read.raw(in.offset() - whole.offset())))
    return VerifyError{0, "the program is not in the shortest form"};
  return verified;
}

void write_debug(ByteWriter& out, const DebugTable& table) {
  out.text(table.source_name);
  std::vector<const DebugEntry*> different;
  const std::vector<std::uint64_t> keys = debug_keys(table.entries, different);
  out.u32(static_cast<std::uint32_t>(different.size()));
  for (const DebugEntry* entry : different) {
    out.u32(entry->line);
    out.u32(entry->column);
    out.text(entry->symbol);
  }
  const std::vector<Repeat> blocks = find_repeats(keys, kLeastStoredRows);
  out.u32(static_cast<std::uint32_t>(blocks.size()));
  std::size_t at = 0;
  for (const Repeat& block : blocks) {
    out.u32(static_cast<std::uint32_t>(block.length));
    out.u32(static_cast<std::uint32_t>(block.rows));
    for (std::size_t i = 0; i < block.length; ++i) out.u32(static_cast<std::uint32_t>(keys[at + i]));
    at += block.length * block.rows;
  }
}

DebugTable read_debug(ByteReader& in, const VerifiedProgram& program) {
  const ByteReader whole = in;
  DebugTable table{in.text(in.left()), {}};
  std::vector<DebugEntry> different(in.count(12));
  for (DebugEntry& entry : different) {
    entry.line = in.u32(), entry.column = in.u32();
    entry.symbol = in.text(in.left());
    if (entry.line == 0 && entry.column != 0) in.fail();
  }
  std::size_t room = kMostRowSymbols;
  for (std::size_t left = in.count(12); left > 0 && !in.failed(); --left) {
    const std::size_t length = in.count(4), rows = in.u32(), begin = table.entries.size();
    if (length == 0 || rows == 0 || length > (program.instructions() - begin) / rows) in.fail();
    for (std::size_t i = 0; i < length && !in.failed(); ++i) {
      const std::uint32_t number = in.u32();
      if (number >= different.size()) {
        in.fail();
      } else {
        table.entries.push_back(different[number]);
      }
    }
    for (std::size_t i = 0; i + length < rows * length && !in.failed(); ++i) {
      DebugEntry again = table.entries[begin + i];
      if (again.symbol.size() > room) in.fail();
      room -= std::min(room, again.symbol.size());
      table.entries.push_back(std::move(again));
    }
  }
  if (!table.entries.empty() && table.entries.size() != program.instructions()) in.fail();
  if (in.failed()) return table;
  const std::vector<std::uint32_t>& words = program.program().words;
  std::size_t at = 0;
  for (DebugEntry& entry : table.entries) {
    entry.offset = static_cast<std::uint32_t>(at);
    at += instruction_length(words[at]);
  }
  ByteWriter again;
  write_debug(again, table);
  ByteReader read = whole;
  if (!std::ranges::equal(again.bytes(), read.raw(in.offset() - whole.offset()))) in.fail();
  return table;
}

VerifiedProgram with_debug(const VerifiedProgram& verified, DebugTable table) {
  Program program = verified.program();
  program.source_name = std::move(table.source_name);
  program.debug = std::move(table.entries);
  constexpr std::uint32_t kAny = ~0u;  // the program already passed the caller's limits
  auto again = verify(std::move(program), {kAny, kAny, kAny});
  return std::get<VerifiedProgram>(std::move(again));
}

Digest opcode_digest() { return digest(std::string(kMachine) + std::string(kRows)); }

}  // namespace fathom::vm
