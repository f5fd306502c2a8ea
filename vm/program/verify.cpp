#include "vm/program/verify.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>
#include <string_view>

namespace fathom::vm {
namespace {

// State of the verifier before the current instruction: heights of the stacks, their maxima, and the written locals.
struct State {
  std::int64_t values = 0, points = 1, max_values = 0, max_points = 1;
  std::vector<bool> written;  // [local]
};

std::optional<std::string> check_immediates(const Program& program, std::size_t at, const OpcodeInfo& row) {
  const std::size_t count = instruction_length(program.words[at]) - 1;
  const auto leading = static_cast<std::size_t>(leading_immediates(program.words[at]));
  for (std::size_t n = 0; n < count; ++n) {
    const std::size_t word = at + 1 + n;
    const int i = n < leading ? -1 : static_cast<int>(n - leading) % row.immediates;
    const std::string_view name = n >= leading              ? immediate_name(row, i)
                                  : row.form == Form::Shape ? std::string_view("xyz").substr(n, 1)
                                                            : "constant";
    const std::uint32_t bits = program.words[word];
    const std::uint32_t largest = n >= leading ? largest_integer(row, i) : 0;
    if (largest > 0) {
      if (bits == 0 || bits > largest) {
        return fmt::format("{}: {} is {}, not in 1..{}", row.mnemonic, name, bits, largest);
      }
    } else if (!std::isfinite(std::bit_cast<float>(bits)) || !std::isfinite(program.doubles[word])) {
      return fmt::format("{}: {} is not finite", row.mnemonic, name);
    } else if (program.doubles[word] == 0 && std::signbit(program.doubles[word])) {
      return fmt::format("{}: {} is -0, which is written 0", row.mnemonic, name);
    } else if (std::bit_cast<std::uint32_t>(static_cast<float>(program.doubles[word])) != bits) {
      return fmt::format("{}: {} is {} in the code but {} in the wide table", row.mnemonic, name,
                         std::bit_cast<float>(bits), program.doubles[word]);
    }
  }
  return std::nullopt;
}

std::optional<std::string> check_local(const OpcodeInfo& row, std::uint32_t local, State& state) {
  if (local >= state.written.size()) {
    return state.written.empty()
               ? fmt::format("{} {}: the program declares 0 locals: `locals {}` is missing before its instructions",
                             row.mnemonic, local, local + 1)
               : fmt::format("{} {}: the program declares {} locals", row.mnemonic, local, state.written.size());
  }
  if (row.opcode == Opcode::Tee) state.written[local] = true;
  if (!state.written[local]) {
    return fmt::format("{} {}: the local is read before it is written", row.mnemonic, local);
  }
  return std::nullopt;
}

std::optional<std::string> check_sources(const OpcodeInfo& row, std::uint32_t word, State& state) {
  const Sources sources = sources_of(word);
  const bool known = sources.a <= Source::Local && sources.b <= Source::Local;
  const bool local = sources.a == Source::Local || sources.b == Source::Local;
  if (!known || (row.form == Form::Unary && sources.b != Source::Stack) || (!local && sources.local != 0)) {
    return fmt::format("{} has no operand {}", row.mnemonic, operand_of(word));
  }
  return local ? check_local(row, sources.local, state) : std::nullopt;
}

std::optional<std::string> check_operand(const OpcodeInfo& row, std::uint32_t word, State& state) {
  const std::uint32_t operand = operand_of(word);
  if (row.form == Form::Unary || row.form == Form::Binary) return check_sources(row, word, state);
  const std::uint32_t most = row.has_operand           ? kMaxOperand
                             : row.form == Form::Shape ? kFusedTranslate | kFusedMin
                                                       : 0;
  if (operand > most) return fmt::format("{} has no operand {}", row.mnemonic, operand);
  if (row.opcode == Opcode::Tee || row.opcode == Opcode::Load) return check_local(row, operand, state);
  return std::nullopt;
}

std::optional<std::string> check_stacks(const OpcodeInfo& row, std::uint32_t word, const Limits& limits,
                                        State& state) {
  const StackEffect effect = effect_of(word);
  if (state.values < effect.values_needed) {
    return fmt::format("{} needs {} values, the stack holds {}", row.mnemonic, effect.values_needed, state.values);
  }
  if (state.points < effect.points_needed) {
    return fmt::format("{} would take the caller's point", row.mnemonic);
  }
  state.values += effect.values_change;
  state.points += effect.points_change;
  state.max_values = std::max(state.max_values, state.values);
  state.max_points = std::max(state.max_points, state.points);
  if (state.max_values > limits.stack || state.max_points > limits.stack) {
    return fmt::format("a stack grows beyond {}", limits.stack);
  }
  return std::nullopt;
}

}  // namespace

std::variant<VerifiedProgram, VerifyError> verify(Program program, const Limits& limits) {
  VerifiedProgram result;
  const std::size_t size = program.words.size();
  if (size > limits.words) return VerifyError{0, fmt::format("{} words; at most {} are allowed", size, limits.words)};
  if (program.doubles.size() != size) return VerifyError{0, "the table of wide constants is not as long as the code"};
  if (program.locals > limits.locals) {
    return VerifyError{0, fmt::format("{} locals; at most {} are allowed", program.locals, limits.locals)};
  }
  State state;
  state.written.assign(program.locals, false);
  for (std::size_t at = 0; at < size;) {
    const auto fail = [&](std::string reason) {
      return VerifyError{static_cast<std::uint32_t>(at), std::move(reason)};
    };
    const std::uint32_t word = program.words[at];
    const OpcodeInfo* row = find_opcode(word & 0xff);
    if (row == nullptr) return fail(fmt::format("no opcode {}", word & 0xff));
    if (group_count(word) < minimum_groups(row->opcode)) {
      return fail(fmt::format("{} has {} groups of immediates; at least {} are needed", row->mnemonic,
                              group_count(word), minimum_groups(row->opcode)));
    }
    if (size - at < instruction_length(word)) return fail(fmt::format("{} is cut off", row->mnemonic));
    if (auto reason = check_immediates(program, at, *row)) return fail(std::move(*reason));
    if (auto reason = check_stacks(*row, word, limits, state)) return fail(std::move(*reason));
    if (auto reason = check_operand(*row, word, state)) return fail(std::move(*reason));
    at += instruction_length(word);
    ++result.instructions_;
    result.choices_ += is_choice(word);
    result.cost_ += static_cast<std::uint32_t>(instruction_cost(word));
  }
  if (state.values != 1 || state.points != 1) {
    return VerifyError{static_cast<std::uint32_t>(size),
                       fmt::format("ends with {} values and {} points, not one of each", state.values, state.points)};
  }
  result.max_values_ = static_cast<std::uint32_t>(state.max_values);
  result.max_points_ = static_cast<std::uint32_t>(state.max_points);
  result.program_ = std::move(program);
  return result;
}

}  // namespace fathom::vm
