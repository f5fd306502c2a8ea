#include "vm/encoding/repeats.h"

#include <bit>
#include <map>
#include <string_view>
#include <tuple>

namespace fathom::vm {
namespace {

constexpr std::size_t kLongestBody = 64;  // instructions

// Returns the repeat that begins at `at` and saves the most keys, or one of no rows.
Repeat repeat_at(std::span<const std::uint64_t> keys, std::size_t at, std::size_t least_rows) {
  Repeat best{0, 0};
  std::size_t saved = 0;
  for (std::size_t length = 1; length <= kLongestBody && at + least_rows * length <= keys.size(); ++length) {
    std::size_t end = at + length;
    while (end < keys.size() && keys[end] == keys[end - length]) ++end;
    const std::size_t rows = (end - at) / length;
    if (rows < least_rows || (rows - 1) * length <= saved) continue;
    saved = (rows - 1) * length;
    best = {length, rows};
  }
  return best;
}

}  // namespace

std::vector<Repeat> find_repeats(std::span<const std::uint64_t> keys, std::size_t least_rows) {
  std::vector<Repeat> blocks;
  std::size_t straight = 0;
  const auto end_straight = [&] {
    if (straight > 0) blocks.push_back({straight, 1});
    straight = 0;
  };
  for (std::size_t at = 0; at < keys.size();) {
    const Repeat repeat = repeat_at(keys, at, least_rows);
    if (repeat.rows == 0) {
      ++straight, ++at;
      continue;
    }
    end_straight();
    blocks.push_back(repeat);
    at += repeat.length * repeat.rows;
  }
  end_straight();
  return blocks;
}

std::vector<std::size_t> offsets_of(const Program& program) {
  std::vector<std::size_t> offsets;
  for (std::size_t at = 0; at < program.words.size(); at += instruction_length(program.words[at]))
    offsets.push_back(at);
  return offsets;
}

std::vector<std::uint64_t> code_keys(const Program& program, std::span<const std::size_t> offsets) {
  std::map<std::vector<std::uint32_t>, std::uint64_t> known;  // numbers of lists of integers
  std::vector<std::uint64_t> keys;
  std::vector<std::uint32_t> integers;
  for (const std::size_t at : offsets) {
    integers.clear();
    for_each_immediate(program.words[at], at, [&](std::size_t word, bool is_float) {
      if (!is_float) integers.push_back(program.words[word]);
    });
    const std::uint64_t number = integers.empty() ? 0 : known.try_emplace(integers, known.size() + 1).first->second;
    keys.push_back(number << 32 | program.words[at]);
  }
  return keys;
}

std::vector<std::size_t> varying_words(const Program& program, std::size_t begin, std::size_t stride,
                                       std::size_t rows) {
  std::vector<std::size_t> varying;
  for (std::size_t word = begin; word < begin + stride; ++word) {
    const auto bits = [&](std::size_t row) {
      return std::bit_cast<std::uint64_t>(program.doubles[word + row * stride]);
    };
    std::size_t row = 1;
    while (row < rows && bits(row) == bits(0)) ++row;
    if (row < rows) varying.push_back(word);
  }
  return varying;
}

std::vector<std::uint64_t> debug_keys(std::span<const DebugEntry> entries,
                                      std::vector<const DebugEntry*>& different) {
  std::map<std::tuple<std::uint32_t, std::uint32_t, std::string_view>, std::uint64_t> known;
  std::vector<std::uint64_t> keys;
  for (const DebugEntry& entry : entries) {
    const auto [found, is_new] = known.try_emplace({entry.line, entry.column, entry.symbol}, known.size());
    if (is_new) different.push_back(&entry);
    keys.push_back(found->second);
  }
  return keys;
}

}  // namespace fathom::vm
