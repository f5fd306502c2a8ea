#include "runtime/adaptive.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>

#include "runtime/sampler.h"
#include "tests/support/effort.h"

namespace fathom::runtime {
namespace {

// A pixel whose samples are 1 / chance so often, else 0: mean 1, the more noisy the rarer. Skewed, as light is.
struct Lottery {
  float chance;
  double draw(Sampler& sampler) const { return sampler.next() < chance ? 1 / static_cast<double>(chance) : 0; }
};

struct Sum {
  double sum = 0, squares = 0;
  int n = 0;
  void add(double value) {
    sum += value;
    squares += value * value;
    ++n;
  }
  double mean() const { return sum / n; }
  double variance() const { return (squares - sum * sum / n) / (n - 1); }
};

// One row of pixels rendered in two stages.
struct Render {
  std::vector<double> combined, pooled;  // [pixel] by first_share(); all samples alike
};

Render render(std::span<const Lottery> pixels, int spp, std::uint64_t seed) {
  const int first = first_samples(spp);
  std::vector<Sum> stage1(pixels.size());
  std::vector<PixelEstimate> estimates;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    Sampler sampler(seed, static_cast<std::uint32_t>(i), 0, 0);
    for (int s = 0; s < first; ++s) stage1[i].add(pixels[i].draw(sampler));
    estimates.push_back({stage1[i].mean(), stage1[i].variance()});
  }
  const std::vector<int> more = second_samples(estimates, static_cast<int>(pixels.size()), 1, spp);
  Render result;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    Sampler sampler(second_seed(seed), static_cast<std::uint32_t>(i), 0, 0);
    Sum stage2;
    for (int s = 0; s < more[i]; ++s) stage2.add(pixels[i].draw(sampler));
    const double w = first_share(spp);
    result.combined.push_back(w * stage1[i].mean() + (1 - w) * stage2.mean());
    result.pooled.push_back((stage1[i].sum + stage2.sum) / (first + more[i]));
  }
  return result;
}

TEST_CASE("adaptive: two stages have the true mean, one mean over both has not") {
  const std::array<Lottery, 3> pixels = {{{0.5f}, {0.1f}, {0.3f}}};
  const int repeats = fathom::test::few(100000);
  std::array<Sum, 3> combined, pooled;
  for (int r = 0; r < repeats; ++r) {
    const Render one = render(pixels, 16, static_cast<std::uint64_t>(r));
    for (std::size_t i = 0; i < 3; ++i) {
      combined[i].add(one.combined[i]);
      pooled[i].add(one.pooled[i]);
    }
  }
  double worst_pooled = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto t = [&](const Sum& s) { return (s.mean() - 1) / std::sqrt(s.variance() / s.n); };
    CAPTURE(i, combined[i].mean(), pooled[i].mean(), t(pooled[i]));
    CHECK(std::abs(t(combined[i])) < 4);
    worst_pooled = std::max(worst_pooled, std::abs(t(pooled[i])));
  }
  CHECK(worst_pooled > 6);  // the test can tell
}

TEST_CASE("adaptive: less error than evenly shared out where pixels differ") {
  std::vector<Lottery> pixels(64, {0.8f});
  for (std::size_t i = 24; i < 32; ++i) pixels[i].chance = 0.05f;
  const int spp = 64, repeats = fathom::test::few(400);
  double adaptive = 0, even = 0;
  for (int r = 0; r < repeats; ++r) {
    const Render one = render(pixels, spp, static_cast<std::uint64_t>(r));
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      adaptive += (one.combined[i] - 1) * (one.combined[i] - 1) / repeats;
      even += (1 / static_cast<double>(pixels[i].chance) - 1) / spp / repeats;
    }
  }
  CAPTURE(adaptive, even, adaptive / even);
  CHECK(adaptive < 0.7 * even);
}

TEST_CASE("adaptive: the budget is used up, every pixel has its least, none more than its most") {
  for (const int spp : {8, 9, 16, 100}) {
    std::vector<PixelEstimate> estimates(60 * 7);
    Sampler sampler(5, 0, 0, 0);
    for (PixelEstimate& pixel : estimates) {
      pixel = {static_cast<double>(sampler.next()), std::pow(static_cast<double>(sampler.next()), 20.0)};
    }
    estimates[200] = {1, 1e9};  // a firefly
    const std::vector<int> more = second_samples(estimates, 60, 7, spp);
    const int average = spp - first_samples(spp);
    CAPTURE(spp);
    CHECK(std::accumulate(more.begin(), more.end(), 0) == 60 * 7 * average);
    CHECK(*std::min_element(more.begin(), more.end()) >= std::max(1, average / 4));
    CHECK(*std::max_element(more.begin(), more.end()) <= 16 * average + 1);
    CHECK(more[200] >= 16 * average - 1);
  }
}

TEST_CASE("adaptive: without noise all pixels have the same, and noise draws samples from the rest") {
  std::vector<PixelEstimate> estimates(20 * 20, {0.5, 0.0});
  for (const int count : second_samples(estimates, 20, 20, 16)) CHECK(count == 12);
  for (std::size_t i = 0; i < estimates.size(); ++i) estimates[i].variance = i % 20 < 10 ? 0.01 : 0.04;
  const std::vector<int> more = second_samples(estimates, 20, 20, 16);
  // Twice the standard deviation, twice the samples: 8 and 16.
  CHECK(std::abs(more[20 * 10 + 2] - 8) <= 1);
  CHECK(std::abs(more[20 * 10 + 17] - 16) <= 1);
  // The same deviation shows less where it is bright.
  for (std::size_t i = 0; i < estimates.size(); ++i) estimates[i] = {i % 20 < 10 ? 1.0 : 0.1, 0.04};
  const std::vector<int> dark = second_samples(estimates, 20, 20, 16);
  CHECK(dark[20 * 10 + 17] > 2 * dark[20 * 10 + 2]);
}

}  // namespace
}  // namespace fathom::runtime
