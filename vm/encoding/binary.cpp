#include "vm/encoding/binary.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <optional>
#include <utility>

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

bool is_wide(const Program& program, std::size_t word) {
  return std::bit_cast<std::uint64_t>(program.doubles[word]) !=
         std::bit_cast<std::uint64_t>(static_cast<double>(std::bit_cast<float>(program.words[word])));
}

// Calls body(word) for every float immediate. Stops at invalid code, for which the verifier has a better message.
template <typename Body>
void for_each_constant(const std::vector<std::uint32_t>& words, const Body& body) {
  for (std::size_t at = 0; at < words.size();) {
    const OpcodeInfo* row = find_opcode(words[at] & 0xff);
    if (row == nullptr) return;
    const std::size_t end = at + instruction_length(words[at]);
    const std::size_t own = at + 1 + static_cast<std::size_t>(leading_immediates(words[at]));
    if (end > words.size()) return;
    for (std::size_t word = at + 1; word < end; ++word) {
      const bool integer = word >= own && is_integer_immediate(*row, static_cast<int>(word - own) % row->immediates);
      if (!integer) body(word);
    }
    at = end;
  }
}

}  // namespace

void write_program(ByteWriter& out, const VerifiedProgram& verified) {
  const Program& program = verified.program();
  out.u32(program.locals);
  out.u32(verified.max_values());
  out.u32(verified.max_points());
  out.u32(static_cast<std::uint32_t>(program.words.size()));
  for (const std::uint32_t word : program.words) out.u32(word);
  std::vector<std::size_t> doubles;
  for_each_constant(program.words, [&](std::size_t word) {
    if (is_wide(program, word)) doubles.push_back(word);
  });
  out.u32(static_cast<std::uint32_t>(doubles.size()));
  for (const std::size_t word : doubles) {
    out.u32(static_cast<std::uint32_t>(word));
    out.f64(program.doubles[word]);
  }
}

std::variant<VerifiedProgram, VerifyError> read_program(ByteReader& in, const Limits& limits) {
  const auto cut_off = [] { return VerifyError{0, "the program is cut off"}; };
  Program program;
  program.locals = in.u32();
  const std::uint32_t max_values = in.u32(), max_points = in.u32();
  program.words.resize(in.count(4));
  for (std::uint32_t& word : program.words) word = in.u32();
  if (in.failed()) return cut_off();
  program.doubles.assign(program.words.size(), 0.0);
  std::vector<bool> constant(program.words.size());
  for_each_constant(program.words, [&](std::size_t word) {
    constant[word] = true;
    program.doubles[word] = static_cast<double>(std::bit_cast<float>(program.words[word]));
  });
  std::optional<VerifyError> misplaced;  // returned only if the code itself passes the verifier
  std::int64_t last = -1;
  for (std::size_t left = in.count(12); left > 0; --left) {
    const std::uint32_t word = in.u32();
    const double value = in.f64();
    if (word >= program.words.size() || word <= last) {
      return VerifyError{word, "the unrounded constants are not in order, or beyond the code"};
    }
    last = word;
    if (!constant[word]) {
      misplaced = VerifyError{word, "an unrounded constant where the code has none"};
      continue;
    }
    program.doubles[word] = value;
    if (!is_wide(program, word)) return VerifyError{word, "an unrounded constant that is the rounded one"};
  }
  if (in.failed()) return cut_off();
  auto verified = verify(std::move(program), limits);
  const auto* good = std::get_if<VerifiedProgram>(&verified);
  if (good && (good->max_values() != max_values || good->max_points() != max_points)) {
    return VerifyError{0, fmt::format("declares stacks of {} values and {} points; the code reaches {} and {}",
                                      max_values, max_points, good->max_values(), good->max_points())};
  }
  if (good && misplaced) return *std::move(misplaced);
  return verified;
}

void write_debug(ByteWriter& out, const VerifiedProgram& verified, std::string_view source_name) {
  const Program& program = verified.program();
  out.text(source_name);
  out.u32(static_cast<std::uint32_t>(program.debug.size()));
  for (const DebugEntry& entry : program.debug) {
    out.u32(entry.line);
    out.u32(entry.column);
    out.text(entry.symbol);
  }
}

DebugTable read_debug(ByteReader& in, const VerifiedProgram& program) {
  DebugTable table{in.text(in.left()), {}};
  const std::size_t count = in.count(12);
  if (count != 0 && count != program.instructions()) in.fail();
  const std::vector<std::uint32_t>& words = program.program().words;
  for (std::size_t i = 0, at = 0; i < count && !in.failed(); ++i) {
    const std::uint32_t line = in.u32(), column = in.u32();
    table.entries.push_back({static_cast<std::uint32_t>(at), line, column, in.text(in.left())});
    if (line == 0 && column != 0) in.fail();
    at += instruction_length(words[at]);
  }
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
