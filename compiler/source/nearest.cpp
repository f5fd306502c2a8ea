// Did you mean: implements nearest() of diagnostics.h.
// Tested by: tests/compiler/source/diagnostics_test.cpp
#include <algorithm>
#include <cctype>
#include <span>
#include <string>
#include <vector>

#include "compiler/source/diagnostics.h"

namespace fathom::compiler {
namespace {

std::string lower(std::string_view text) {
  std::string out(text);
  for (char& c : out) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return out;
}

// Bounds on the time that a file full of mistakes takes.
constexpr std::size_t kLongestWord = 40;  // letters; longer words get no suggestion
constexpr std::size_t kMaxCandidates = 4000;

// Returns the number of insertions, deletions, replacements and swaps of neighbours that turn `a` into `b`: the
// optimal string alignment distance (Damerau, "A technique for computer detection and correction of spelling errors",
// 1964; no substring is edited twice). Returns more than `most` if the distance exceeds `most`.
std::size_t edits(std::string_view a, std::string_view b, std::size_t most) {
  const auto begin = std::mismatch(a.begin(), a.end(), b.begin(), b.end());  // the common prefix needs no edit
  a.remove_prefix(static_cast<std::size_t>(begin.first - a.begin()));
  b.remove_prefix(static_cast<std::size_t>(begin.second - b.begin()));
  std::vector<std::size_t> before_last, last(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) last[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        row[j] = std::min(row[j], before_last[j - 2] + 1);
      }
    }
    if (*std::min_element(row.begin(), row.end()) > most) return most + 1;
    before_last = last;
    last = row;
  }
  return last[b.size()];
}

}  // namespace

std::string_view nearest(std::string_view word, const std::vector<std::string_view>& candidates) {
  if (word.size() > kLongestWord) return {};
  // Allows one typing error per three letters, and one in a word of one or two letters.
  const std::size_t most = std::max<std::size_t>(1, word.size() / 3);
  std::string_view best;
  std::size_t fewest = most + 1;
  const std::string lowered = lower(word);
  for (const std::string_view candidate : std::span(candidates).first(std::min(candidates.size(), kMaxCandidates))) {
    const std::size_t longer = std::max(candidate.size(), word.size());
    if (longer - std::min(candidate.size(), word.size()) > most) continue;
    const std::size_t distance = edits(lowered, lower(candidate), most);
    // A word with nothing in common with the candidate is not a misspelling of it, however short both are.
    if (distance < fewest && distance < longer) {
      fewest = distance;
      best = candidate;
    }
  }
  return best;
}

}  // namespace fathom::compiler
