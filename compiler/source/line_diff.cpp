#include "compiler/source/line_diff.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

namespace fathom::compiler {
namespace {

using Lines = std::vector<std::string_view>;

constexpr std::size_t kContext = 3;  // unchanged lines around a change, as in diff -u

Lines split(std::string_view text) {
  Lines lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    lines.push_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

// A line of the result: kept (' '), gone ('-') or new ('+').
struct Edit {
  char mark;
  std::string_view line;
};

// Numbers the lines so that equal lines have equal numbers: align() compares every pair of lines, and a line can be a
// megabyte.
std::pair<std::vector<std::size_t>, std::vector<std::size_t>> numbered(const Lines& before, const Lines& after) {
  std::unordered_map<std::string_view, std::size_t> numbers;
  const auto of = [&](const Lines& lines) {
    std::vector<std::size_t> out;
    for (const std::string_view line : lines) out.push_back(numbers.try_emplace(line, numbers.size()).first->second);
    return out;
  };
  auto first = of(before);
  return {std::move(first), of(after)};
}

// Returns the edits that keep a longest common subsequence of lines. Source: Wagner & Fischer, "The string-to-string
// correction problem", 1974. Memory and time grow with the product of the lengths.
std::vector<Edit> align(const Lines& before, const Lines& after) {
  const auto [old_lines, new_lines] = numbered(before, after);
  const std::size_t columns = after.size() + 1;
  // [before][after] length of the longest common subsequence of the lines from there on
  std::vector<std::uint16_t> common((before.size() + 1) * columns, 0);
  const auto at = [&](std::size_t i, std::size_t j) -> std::uint16_t& { return common[i * columns + j]; };
  for (std::size_t i = before.size(); i-- > 0;) {
    for (std::size_t j = after.size(); j-- > 0;) {
      at(i, j) = old_lines[i] == new_lines[j] ? static_cast<std::uint16_t>(at(i + 1, j + 1) + 1)
                                              : std::max(at(i + 1, j), at(i, j + 1));
    }
  }
  std::vector<Edit> edits;
  std::size_t i = 0, j = 0;
  while (i < before.size() || j < after.size()) {
    if (i < before.size() && j < after.size() && old_lines[i] == new_lines[j]) {
      edits.push_back({' ', before[i++]}), ++j;
    } else if (j == after.size() || (i < before.size() && at(i + 1, j) >= at(i, j + 1))) {
      edits.push_back({'-', before[i++]});
    } else {
      edits.push_back({'+', after[j++]});
    }
  }
  return edits;
}

// Returns one past the last edit of the hunk that starts at `begin`. A hunk joins changes that are at most twice the
// context apart.
std::size_t hunk_end(const std::vector<Edit>& edits, std::size_t begin) {
  std::size_t last_change = begin;
  for (std::size_t i = begin; i < edits.size() && i <= last_change + 2 * kContext + 1; ++i) {
    if (edits[i].mark != ' ') last_change = i;
  }
  return std::min(edits.size(), last_change + 1 + kContext);
}

std::string print_hunks(const std::vector<Edit>& edits) {
  std::string out;
  std::size_t before = 1, after = 1, at = 0;  // the next line's number in either text, and the next edit
  const auto advance = [&](std::size_t to) {
    for (; at < to; ++at) {
      before += edits[at].mark != '+';
      after += edits[at].mark != '-';
    }
  };
  for (std::size_t change = 0; change < edits.size(); ++change) {
    if (edits[change].mark == ' ') continue;
    const std::size_t begin = std::max(at, change < kContext ? 0 : change - kContext), end = hunk_end(edits, change);
    advance(begin);
    const std::size_t first_before = before, first_after = after;
    std::string lines;
    for (std::size_t i = begin; i < end; ++i) lines += fmt::format("{}{}\n", edits[i].mark, edits[i].line);
    advance(end);
    // The line before an empty range names the range.
    const std::size_t gone = before - first_before, come = after - first_after;
    out += fmt::format("@@ -{},{} +{},{} @@\n{}", first_before - (gone == 0), gone, first_after - (come == 0), come,
                       lines);
    change = end - 1;
  }
  return out;
}

}  // namespace

std::string unified_diff(std::string_view before_text, std::string_view after_text, std::size_t limit) {
  Lines before = split(before_text), after = split(after_text);
  std::vector<Edit> head, tail;
  const std::size_t shorter = std::min(before.size(), after.size());
  std::size_t same = 0, same_end = 0;
  while (same < shorter && before[same] == after[same]) ++same;
  while (same_end < shorter - same && before[before.size() - 1 - same_end] == after[after.size() - 1 - same_end]) {
    ++same_end;
  }
  for (std::size_t i = 0; i < same; ++i) head.push_back({' ', before[i]});
  for (std::size_t i = before.size() - same_end; i < before.size(); ++i) tail.push_back({' ', before[i]});
  const Lines changed(before.begin() + static_cast<std::ptrdiff_t>(same),
                      before.end() - static_cast<std::ptrdiff_t>(same_end));
  const Lines into(after.begin() + static_cast<std::ptrdiff_t>(same),
                   after.end() - static_cast<std::ptrdiff_t>(same_end));
  if (std::max(changed.size(), into.size()) > limit) {
    return fmt::format("; {} lines became {}: too many to compare\n", changed.size(), into.size());
  }
  std::vector<Edit> edits = std::move(head);
  const std::vector<Edit> middle = align(changed, into);
  edits.insert(edits.end(), middle.begin(), middle.end());
  edits.insert(edits.end(), tail.begin(), tail.end());
  return print_hunks(edits);
}

}  // namespace fathom::compiler
