// Coverage against a plain table of samples: covered, missing and doubled samples, for any blocks.
#include "runtime/base/coverage.h"
#include "tests/support/catch.h"

#include <algorithm>
#include <chrono>
#include <random>
#include <vector>

namespace fathom::runtime::coverage_test {
namespace {

constexpr int kSide = 9, kDepth = 7;

// [sample][y][x]
using Table = std::vector<int>;

void mark(Table& table, const SampleBlock& block) {
  for (std::uint32_t s = block.samples.first; s < block.samples.last; ++s) {
    for (int y = block.area.y0; y < block.area.y1; ++y) {
      for (int x = block.area.x0; x < block.area.x1; ++x) {
        ++table[(s * kSide + static_cast<std::uint32_t>(y)) * kSide + static_cast<std::uint32_t>(x)];
      }
    }
  }
}

Table table_of(const std::vector<SampleBlock>& blocks) {
  Table table(kSide * kSide * kDepth);
  for (const SampleBlock& block : blocks) mark(table, block);
  return table;
}

class RandomBlocks {
 public:
  explicit RandomBlocks(unsigned seed) : engine_(seed) {}
  int whole(int below) { return std::uniform_int_distribution<int>(0, below - 1)(engine_); }
  SampleBlock block() {
    const int x = whole(kSide), y = whole(kSide), s = whole(kDepth);
    return {{x, y, x + 1 + whole(kSide - x), y + 1 + whole(kSide - y)},
            {static_cast<std::uint32_t>(s), static_cast<std::uint32_t>(s + 1 + whole(kDepth - s))}};
  }
  std::mt19937& engine() { return engine_; }

 private:
  std::mt19937 engine_;
};

// Disjoint random blocks.
Coverage random_coverage(RandomBlocks& random, int blocks) {
  Coverage covered;
  for (int i = 0; i < blocks; ++i) {
    for (const SampleBlock& piece : covered.missing(random.block())) covered.add(piece);
    covered.canonicalise();
  }
  return covered;
}

TEST_CASE("coverage: the tidy form is known when it is seen", "[base]") {
  int canonicalise = 0, untidy = 0;
  for (unsigned seed = 0; seed < 4000; ++seed) {
    RandomBlocks random(seed);
    Coverage covered;
    // The canonical form with one block removed, added or changed, or unchanged.
    std::vector<SampleBlock> blocks = random_coverage(random, random.whole(4)).blocks();
    const int change = random.whole(5);
    if (change == 1 && !blocks.empty()) blocks.pop_back();
    if (change == 2)
      blocks.insert(blocks.begin() + random.whole(static_cast<int>(blocks.size()) + 1), random.block());
    if (change >= 3 && !blocks.empty()) {
      SampleBlock& block = blocks[static_cast<std::size_t>(random.whole(static_cast<int>(blocks.size())))];
      if (change == 3) block = random.block();
      if (change == 4) ++block.samples.last;
    }
    for (const SampleBlock& block : blocks) covered.add(block);
    Coverage form = covered;
    form.canonicalise();
    CHECK(form.is_canonical());
    CHECK(covered.is_canonical() == (covered == form));
    ++(covered.is_canonical() ? canonicalise : untidy);
  }
  CHECK(canonicalise > 500);
  CHECK(untidy > 500);
}

TEST_CASE("coverage: missing is what is not there, once", "[base]") {
  for (unsigned seed = 0; seed < 300; ++seed) {
    RandomBlocks random(seed);
    const Coverage covered = random_coverage(random, 1 + random.whole(8));
    const SampleBlock asked = random.block();
    Table sum = table_of(covered.blocks());
    REQUIRE(*std::max_element(sum.begin(), sum.end()) == 1);
    const std::vector<SampleBlock> missing = covered.missing(asked);
    for (const SampleBlock& piece : missing) {
      mark(sum, piece);
      REQUIRE(intersection(piece, asked) == piece);
    }
    REQUIRE(*std::max_element(sum.begin(), sum.end()) == 1);
    Table wanted = table_of({asked});
    for (std::size_t i = 0; i < sum.size(); ++i) REQUIRE((wanted[i] == 0 || sum[i] == 1));
    REQUIRE(covered.covers(asked) == missing.empty());
  }
}

TEST_CASE("coverage: its form depends on what is covered alone", "[base]") {
  for (unsigned seed = 0; seed < 300; ++seed) {
    RandomBlocks random(seed);
    const Coverage covered = random_coverage(random, 6);
    // The same coverage in single pixels and samples, in another order.
    std::vector<SampleBlock> grains;
    for (const SampleBlock& block : covered.blocks()) {
      for (std::uint32_t s = block.samples.first; s < block.samples.last; ++s) {
        for (int y = block.area.y0; y < block.area.y1; ++y) {
          for (int x = block.area.x0; x < block.area.x1; ++x) grains.push_back({{x, y, x + 1, y + 1}, {s, s + 1}});
        }
      }
    }
    std::shuffle(grains.begin(), grains.end(), random.engine());
    Coverage again;
    for (const SampleBlock& grain : grains) again.add(grain);
    again.canonicalise();
    REQUIRE(again == covered);
    REQUIRE(again.size() == grains.size());
  }
}

TEST_CASE("coverage: overlaps are found, and only those", "[base]") {
  int some = 0;
  for (unsigned seed = 0; seed < 300; ++seed) {
    RandomBlocks random(seed);
    const Coverage a = random_coverage(random, 3), b = random_coverage(random, 2);
    Table sum = table_of(a.blocks());
    for (const SampleBlock& block : b.blocks()) mark(sum, block);
    const bool doubled = *std::max_element(sum.begin(), sum.end()) > 1;
    const auto overlap = a.overlap(b);
    REQUIRE(overlap.has_value() == doubled);
    some += doubled;
    if (overlap) REQUIRE((a.covers(*overlap) && b.covers(*overlap)));
  }
  CHECK(some > 50);
  CHECK(some < 290);
}

// Regression: one row of the image can have as many blocks as a file has room for. Comparing each block with each
// other took minutes.
TEST_CASE("coverage: whether many blocks are apart is soon known", "[base]") {
  Coverage even, odd;
  for (std::uint32_t i = 0; i < 200000; ++i) {
    even.add({{0, 0, 9, 1}, {4 * i, 4 * i + 1}});
    odd.add({{0, 0, 9, 1}, {4 * i + 2, 4 * i + 3}});
  }
  REQUIRE(even.is_canonical());
  const auto start = std::chrono::steady_clock::now();
  CHECK_FALSE(even.overlap(odd));
  CHECK(even.overlap(even));
  CHECK(even.missing({{0, 0, 9, 1}, {0, 800000}}).size() == 200000);
  CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(10));
}

}  // namespace
}  // namespace fathom::runtime::coverage_test
