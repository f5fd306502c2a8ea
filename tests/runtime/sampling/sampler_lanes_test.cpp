// Samplers in lanes against Sampler, bit for bit.
#include "runtime/sampling/sampler_lanes.h"

#include <bit>
#include <random>
#include <vector>

#include "tests/support/catch.h"
#include "tests/support/scaled_cases.h"

namespace fathom::runtime::sampler_lanes_test {
namespace {

bool same_bits(float a, float b) { return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b); }

struct Samplers {
  SamplerRows rows;
  std::vector<Sampler> each;
};

// Returns samplers of random pixels, samples and bounces.
Samplers random_samplers(const SamplePlan& plan, std::size_t count, std::mt19937& random) {
  Samplers samplers;
  for (std::size_t i = 0; i < count; ++i) {
    const PixelKey pixel(plan, random() % 5000, random() % 5000);
    // A quarter of the samples lies beyond the plan.
    const auto spp = static_cast<std::uint32_t>(plan.spp);
    samplers.each.emplace_back(pixel, static_cast<std::uint32_t>(random()) % (spp + (spp + 2) / 3));
    samplers.rows.set(i, samplers.each[i]);
    if (random() % 2 == 0) continue;
    const int bounce = static_cast<int>(random() % 30);
    samplers.each[i].start_bounce(bounce);
    samplers.rows.start_bounce(i, bounce);
  }
  return samplers;
}

// Draws pairs, then numbers for every other sampler, then pairs, with both. Returns the number of differences.
int count_differences(Samplers& samplers) {
  const std::size_t count = samplers.each.size();
  alignas(64) float u[SamplerRows::kCapacity], v[SamplerRows::kCapacity];
  int differences = 0;
  const auto check_pairs = [&] {
    samplers.rows.draw_pairs(count, u, v);
    samplers.rows.take_pairs(count);
    for (std::size_t i = 0; i < count; ++i) {
      const glm::vec2 pair = samplers.each[i].next2();
      differences += !same_bits(pair.x, u[i]) + !same_bits(pair.y, v[i]);
    }
  };
  check_pairs();
  samplers.rows.draw(count, u);
  for (std::size_t i = 0; i < count; i += 2) {
    samplers.rows.take_number(i);
    differences += !same_bits(samplers.each[i].next(), u[i]);
  }
  check_pairs();
  return differences;
}

TEST_CASE("sampler lanes: the numbers are those of each sampler", "[sampling]") {
  std::mt19937 random(1);
  const int rounds = test::scaled_cases(80);
  for (const SamplerKind kind : {SamplerKind::Blue, SamplerKind::Sobol, SamplerKind::Independent}) {
    for (const int spp : {1, 2, 7, 64, 65536}) {
      CAPTURE(static_cast<int>(kind), spp);
      int differences = 0;
      for (int round = 0; round < rounds; ++round) {
        const SamplePlan plan{kind, random(), spp};
        Samplers samplers = random_samplers(plan, 1 + random() % SamplerRows::kCapacity, random);
        differences += count_differences(samplers);
      }
      CHECK(differences == 0);
    }
  }
}

TEST_CASE("sampler lanes: numbers drawn and not taken are drawn again", "[sampling]") {
  std::mt19937 random(2);
  Samplers samplers = random_samplers({SamplerKind::Blue, 3, 16}, 20, random);
  float u[SamplerRows::kCapacity], again[SamplerRows::kCapacity], next[SamplerRows::kCapacity];
  samplers.rows.draw(20, u);
  samplers.rows.draw(20, again);
  samplers.rows.take_numbers(20);
  samplers.rows.draw(20, next);
  for (std::size_t i = 0; i < 20; ++i) {
    CHECK(u[i] == again[i]);
    CHECK(u[i] != next[i]);
  }
}

}  // namespace
}  // namespace fathom::runtime::sampler_lanes_test
