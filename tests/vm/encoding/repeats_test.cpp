// Repeats: the blocks are the sequence, and runs of bodies are found whatever stands around them.
#include "vm/encoding/repeats.h"

#include <string>
#include <vector>

#include "tests/support/catch.h"
#include "tests/support/random/random_scene.h"

namespace fathom::test::repeats_test {
namespace {

std::vector<std::uint64_t> keys_of(const std::string& text) { return {text.begin(), text.end()}; }

// Returns blocks as e.g. "2x1 3x5".
std::string blocks_of(const std::string& text, std::size_t least_rows) {
  std::string found;
  for (const vm::Repeat& block : vm::find_repeats(keys_of(text), least_rows))
    found += (found.empty() ? "" : " ") + std::to_string(block.length) + "x" + std::to_string(block.rows);
  return found;
}

}  // namespace

TEST_CASE("repeats: bodies are found between other instructions", "[encoding]") {
  CHECK(blocks_of("", 4).empty());
  CHECK(blocks_of("abcdef", 4) == "6x1");
  CHECK(blocks_of("aaaa", 4) == "1x4");
  CHECK(blocks_of("aaa", 4) == "3x1");
  CHECK(blocks_of("pabcabcabcabcq", 4) == "1x1 3x4 1x1");
  CHECK(blocks_of("pabcabcabcabcq", 5) == "14x1");
  CHECK(blocks_of("aaaaabababababc", 4) == "1x5 2x4 2x1");
}

TEST_CASE("repeats: blocks together are the sequence", "[encoding]") {
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    Random random(seed);
    std::vector<std::uint64_t> keys;
    while (keys.size() < 200) {
      const std::size_t length = 1 + random.below(5), rows = 1 + random.below(9), begin = keys.size();
      for (std::size_t i = 0; i < length; ++i) keys.push_back(random.below(3));
      for (std::size_t i = length; i < length * rows; ++i) keys.push_back(keys[begin + i - length]);
    }
    std::size_t at = 0;
    for (const vm::Repeat& block : vm::find_repeats(keys, 4)) {
      CHECK((block.rows == 1 || block.rows >= 4));
      for (std::size_t i = block.length; i < block.length * block.rows; ++i)
        CHECK(keys[at + i] == keys[at + i - block.length]);
      at += block.length * block.rows;
    }
    CHECK(at == keys.size());
  }
}

}  // namespace fathom::test::repeats_test
