#include "runtime/sampling/sampler.h"

#include <bit>
#include <cmath>
#include <glm/vec2.hpp>
#include <set>
#include <vector>

#include "tests/support/catch.h"
#include "tests/support/scaled_cases.h"

namespace fathom::runtime::sampler_test {
namespace {

TEST_CASE("sampler: a function of its key alone", "[sampling]") {
  Sampler first(7, 3, 4, 5), again(7, 3, 4, 5);
  for (int i = 0; i < 100; ++i) CHECK(first.next() == again.next());
}

TEST_CASE("sampler: every part of the key matters", "[sampling]") {
  std::set<float> seen;
  for (Sampler s : {Sampler(0, 0, 0, 0), Sampler(1, 0, 0, 0), Sampler(0, 1, 0, 0), Sampler(0, 0, 1, 0),
                    Sampler(0, 0, 0, 1), Sampler(1ull << 63, 0, 0, 0)}) {
    seen.insert(s.next());
  }
  CHECK(seen.size() == 6);
}

// Chi-square over a 16 x 16 grid: 255 degrees of freedom, mean 255, standard deviation sqrt(510).
double chi_square(const std::vector<int>& counts, double expected) {
  double sum = 0;
  for (int count : counts) sum += (count - expected) * (count - expected) / expected;
  return sum;
}

TEST_CASE("sampler: pairs are even, over dimensions and over neighbouring pixels", "[sampling]") {
  const int n = 1 << 18;
  std::vector<int> along(256), across(256), samples(256);
  for (int i = 0; i < n; ++i) {
    const std::uint32_t x = static_cast<std::uint32_t>(i % 512), y = static_cast<std::uint32_t>(i / 512);
    Sampler sampler(0, x, y, 0), neighbour(0, x + 1, y, 0), later(0, x, y, 1);
    const float a = sampler.next();
    const auto cell = [&](float b) {
      return static_cast<std::size_t>(a * 16) * 16 + static_cast<std::size_t>(b * 16);
    };
    ++along[cell(sampler.next())];
    ++across[cell(neighbour.next())];
    ++samples[cell(later.next())];
  }
  const double limit = 255 + 4 * std::sqrt(510.0);
  CHECK(chi_square(along, n / 256.0) < limit);
  CHECK(chi_square(across, n / 256.0) < limit);
  CHECK(chi_square(samples, n / 256.0) < limit);
}

TEST_CASE("sampler: numbers lie from 0 up to, but not at, 1", "[sampling]") {
  Sampler sampler(1, 2, 3, 4);
  for (int i = 0; i < 1 << 20; ++i) {
    const float u = sampler.next();
    if (!(u >= 0 && u < 1)) FAIL("out of range: " << u);
  }
}

constexpr SamplerKind kKinds[] = {SamplerKind::Independent, SamplerKind::Sobol, SamplerKind::Blue};

glm::vec2 pair_of(const SamplePlan& plan, std::uint32_t x, std::uint32_t y, std::uint32_t sample, int bounce) {
  Sampler sampler(PixelKey(plan, x, y), sample);
  if (bounce >= 0) sampler.start_bounce(bounce);
  return sampler.next2();
}

TEST_CASE("sampler: asked again in another order the numbers are the same, of every kind", "[sampling]") {
  for (const SamplerKind kind : kKinds) {
    const SamplePlan plan{kind, 11, 9};
    std::vector<glm::vec2> there, back;
    const auto ask = [&](int i) {
      const auto u = static_cast<std::uint32_t>(i);
      Sampler sampler(PixelKey(plan, u % 7, u / 7 % 5), u % 9);
      sampler.next2();
      sampler.start_bounce(i % 4);
      const float single = sampler.next();
      return glm::vec2(single, sampler.next2().y);
    };
    for (int i = 0; i < 500; ++i) there.push_back(ask(i));
    for (int i = 499; i >= 0; --i) back.insert(back.begin(), ask(i));
    CHECK(there == back);
  }
}

TEST_CASE("sampler: what a bounce draws does not depend on what was drawn before it", "[sampling]") {
  for (const SamplerKind kind : {SamplerKind::Sobol, SamplerKind::Blue}) {
    const PixelKey pixel({kind, 1, 16}, 3, 4);
    Sampler busy(pixel, 5), idle(pixel, 5);
    for (int i = 0; i < 9; ++i) busy.next();
    busy.start_bounce(2);
    idle.start_bounce(2);
    CHECK(busy.next2() == idle.next2());
    // next() returns the first number of a pair.
    idle.start_bounce(2);
    busy.start_bounce(2);
    CHECK(idle.next() == busy.next2().x);
    // No two bounces share a pair.
    std::set<float> seen;
    for (int bounce = 0; bounce < 20; ++bounce) {
      idle.start_bounce(bounce);
      for (int i = 0; i < Sampler::kPairsPerBounce; ++i) seen.insert(idle.next());
    }
    CHECK(seen.size() >= 20 * Sampler::kPairsPerBounce - 1);  // two of 320 numbers may be equal in 24 bits
  }
}

// True if every rectangle 2^-i by 2^-(bits-i), i = 0 .. bits, contains one of the 2^bits points.
bool is_net(const std::vector<glm::vec2>& points, int bits) {
  for (int i = 0; i <= bits; ++i) {
    std::vector<bool> taken(points.size(), false);
    for (const glm::vec2 p : points) {
      const auto column = static_cast<std::size_t>(p.x * static_cast<float>(1 << i));
      const auto row = static_cast<std::size_t>(p.y * static_cast<float>(1 << (bits - i)));
      const std::size_t cell = column << (bits - i) | row;
      if (taken[cell]) return false;
      taken[cell] = true;
    }
  }
  return true;
}

TEST_CASE("sampler: each run of 2^k samples of a pixel is a net, in every pair of dimensions", "[sampling]") {
  for (const SamplerKind kind : {SamplerKind::Sobol, SamplerKind::Blue}) {
    for (int bits = 0; bits <= 12; ++bits) {
      const int count = 1 << bits;
      for (int pixel = 0; pixel < fathom::test::scaled_cases(6); ++pixel) {
        for (const int bounce : {-1, 0, 3}) {
          // The plan has twice as many samples: the second run is a net, too. Seed and position vary.
          const SamplePlan plan{kind, static_cast<std::uint64_t>(pixel), 2 * count};
          std::vector<glm::vec2> first, second;
          for (int i = 0; i < count; ++i) {
            const auto x = static_cast<std::uint32_t>(977 * pixel), sample = static_cast<std::uint32_t>(i);
            first.push_back(pair_of(plan, x, 5, sample, bounce));
            second.push_back(pair_of(plan, x, 5, sample + static_cast<std::uint32_t>(count), bounce));
          }
          CAPTURE(kind, bits, pixel, bounce);
          CHECK(is_net(first, bits));
          CHECK(is_net(second, bits));
        }
      }
    }
  }
  // Control: independent samples are not a net.
  std::vector<glm::vec2> random;
  for (std::uint32_t i = 0; i < 64; ++i) random.push_back(pair_of({SamplerKind::Independent, 0, 64}, 0, 0, i, -1));
  CHECK(!is_net(random, 6));
}

// The pixels of an aligned square of 2^k per side together have the samples of one run.
TEST_CASE("sampler: of the kind blue aligned squares of pixels are nets, too", "[sampling]") {
  for (const int spp : {1, 2, 4, 16}) {
    for (int level = 1; level <= 3; ++level) {
      for (const int bounce : {-1, 2}) {
        std::vector<glm::vec2> points;
        const std::uint32_t side = 1u << level, x0 = 5 * side, y0 = 3 * side;
        for (std::uint32_t y = y0; y < y0 + side; ++y) {
          for (std::uint32_t x = x0; x < x0 + side; ++x) {
            for (int i = 0; i < spp; ++i) {
              points.push_back(pair_of({SamplerKind::Blue, 9, spp}, x, y, static_cast<std::uint32_t>(i), bounce));
            }
          }
        }
        CAPTURE(spp, level, bounce);
        CHECK(is_net(points, static_cast<int>(std::bit_width(points.size())) - 1));
      }
    }
  }
}

TEST_CASE("sampler: one sample is anywhere, whatever the kind, over seeds, pixels and pairs", "[sampling]") {
  const int n = fathom::test::scaled_cases(1 << 16);
  const double limit = 255 + 4 * std::sqrt(510.0);
  for (const SamplerKind kind : kKinds) {
    std::vector<int> of_seeds(256), of_pixels(256), of_bounces(256), across_pairs(256);
    const auto cell = [](glm::vec2 u) {
      return static_cast<std::size_t>(u.x * 16) * 16 + static_cast<std::size_t>(u.y * 16);
    };
    for (int i = 0; i < n; ++i) {
      const auto u = static_cast<std::uint32_t>(i);
      const SamplePlan plan{kind, u, 8};
      ++of_seeds[cell(pair_of(plan, 1, 2, 3, -1))];
      // The pixels are far apart, because neighbours divide the square among themselves.
      ++of_pixels[cell(pair_of({kind, 1, 1}, (u % 256) * 251, (u / 256) * 241, 0, 0))];
      ++of_bounces[cell(pair_of({kind, 1, 8}, 3, 4, 5, i))];
      Sampler sampler(PixelKey(plan, 7, 7), 6);
      const float a = sampler.next2().y;
      ++across_pairs[cell({a, sampler.next2().x})];
    }
    CAPTURE(kind);
    CHECK(chi_square(of_seeds, n / 256.0) < limit);
    CHECK(chi_square(of_pixels, n / 256.0) < limit);
    // Independent samples do not depend on the bounce.
    if (kind != SamplerKind::Independent) CHECK(chi_square(of_bounces, n / 256.0) < limit);
    CHECK(chi_square(across_pairs, n / 256.0) < limit);
  }
}

TEST_CASE("sampler: more samples than were planned are still all different, and pixels at the far end, too",
          "[sampling]") {
  for (const SamplerKind kind : kKinds) {
    std::set<std::uint64_t> seen;
    for (const std::uint32_t place : {0u, 65534u}) {
      for (std::uint32_t i = 0; i < 200; ++i) {
        const glm::vec2 u = pair_of({kind, 3, 5}, place, place, i, 0);
        CHECK((u.x >= 0 && u.x < 1 && u.y >= 0 && u.y < 1));
        seen.insert(static_cast<std::uint64_t>(u.x * 0x1p24f) << 24 | static_cast<std::uint64_t>(u.y * 0x1p24f));
      }
    }
    CHECK(seen.size() == 400);
  }
}

}  // namespace
}  // namespace fathom::runtime::sampler_test
