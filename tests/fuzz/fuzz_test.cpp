// Runs every fuzz target on its seeds and on the inputs that once broke it (tests/fuzz/found/NAME). `scripts/fuzz`
// continues from the same inputs.
#include <algorithm>
#include <string>

#include "tests/fuzz/target.h"
#include "tests/support/catch.h"
#include "tests/support/random/random_scene.h"

namespace fathom::fuzz::fuzz_test {
namespace {

// Returns each target in turn.
const Target& any_target() {
  return targets()[static_cast<std::size_t>(GENERATE(range(0, static_cast<int>(targets().size()))))];
}

void run_all(const Target& target, const std::vector<Input>& inputs) {
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    INFO(target.name << ", input " << i << ": " << to_text(inputs[i]).substr(0, 400));
    CHECK_NOTHROW(target.run(inputs[i]));
  }
}

// Random number below n, n > 0.
std::ptrdiff_t pick(test::Random& random, std::size_t n) { return random.below(static_cast<int>(n)); }

// Damages an input as files get damaged: another byte, or a run of bytes that is left out, repeated or taken from
// another file.
void damage(Input& input, const Input& other, test::Random& random) {
  constexpr std::size_t kLongest = 16;
  const auto stretch_from = [&](const Input& of, std::ptrdiff_t at) {
    return pick(random, std::min(of.size() - static_cast<std::size_t>(at), kLongest) + 1);
  };
  const std::ptrdiff_t at = pick(random, input.size() + 1);
  const int way = random.below(4);
  if (way == 0) {
    if (at < std::ssize(input)) input[static_cast<std::size_t>(at)] = static_cast<std::uint8_t>(random.bits());
  } else if (way == 1) {
    input.erase(input.begin() + at, input.begin() + at + stretch_from(input, at));
  } else {
    const Input from = way == 2 ? input : other;
    const std::ptrdiff_t begin = pick(random, from.size() + 1);
    input.insert(input.begin() + at, from.begin() + begin, from.begin() + begin + stretch_from(from, begin));
  }
}

}  // namespace

TEST_CASE("fuzz targets keep their promises on their seeds", "[fuzz]") {
  const Target& target = any_target();
  const std::vector<Input> seeds = target.seeds();
  CHECK(seeds.size() >= 8);
  run_all(target, seeds);
}

// A short version of `scripts/fuzz` without coverage guidance: seeds with a few bytes changed.
TEST_CASE("fuzz targets keep their promises on seeds that were damaged", "[fuzz]") {
  constexpr int kRuns = 100;
  const Target& target = any_target();
  const std::vector<Input> seeds = target.seeds();
  test::Random random(7);
  std::vector<Input> damaged;
  for (int i = 0; i < kRuns; ++i) {
    const auto any = [&] { return seeds[static_cast<std::size_t>(pick(random, seeds.size()))]; };
    damaged.push_back(any());
    for (int left = 1 + random.below(3); left > 0; --left) damage(damaged.back(), any(), random);
  }
  run_all(target, damaged);
}

TEST_CASE("fuzz targets keep their promises on what once broke them", "[fuzz]") {
  std::size_t count = 0;
  for (const Target& target : targets()) {
    const std::vector<Input> found = files_below("tests/fuzz/found/" + std::string(target.name), "", 1 << 20);
    run_all(target, found);
    count += found.size();
  }
  CHECK(count > 0);
}

TEST_CASE("fuzz targets say of a broken promise what broke", "[fuzz]") {
  CHECK_THROWS_WITH(promise(false, "two is not three"), "two is not three");
  CHECK_NOTHROW(promise(true, "nothing"));
  CHECK(find_target("nothing") == nullptr);
}

}  // namespace fathom::fuzz::fuzz_test
