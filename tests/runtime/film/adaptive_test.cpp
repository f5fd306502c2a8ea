#include "runtime/film/adaptive.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <catch2/catch.hpp>
#include <cmath>
#include <memory>
#include <numeric>

#include "runtime/render.h"
#include "runtime/sampling/sampler.h"
#include "tests/runtime/scenes.h"
#include "tests/support/effort.h"

namespace fathom::runtime::adaptive_test {
namespace {

// A pixel with samples of 1 / chance, which occur with probability `chance`, and 0 otherwise. The mean is 1, and the
// noise grows as the chance falls. Skewed, as light is.
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
struct Row {
  // Per pixel: both stages weighted by first_share(), and all samples weighted equally.
  std::vector<double> combined, pooled;
};

Row render(std::span<const Lottery> pixels, int spp, std::uint64_t seed) {
  const int first = first_samples(spp);
  std::vector<Sum> stage1(pixels.size());
  std::vector<PixelEstimate> estimates;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    Sampler sampler(seed, static_cast<std::uint32_t>(i), 0, 0);
    for (int s = 0; s < first; ++s) stage1[i].add(pixels[i].draw(sampler));
    estimates.push_back({stage1[i].mean(), stage1[i].variance()});
  }
  const std::vector<int> more = second_samples(estimates, static_cast<int>(pixels.size()), 1, spp);
  Row result;
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
  const int repeats = 100000;
  std::array<Sum, 3> combined, pooled;
  for (int r = 0; r < repeats; ++r) {
    const Row one = render(pixels, 16, static_cast<std::uint64_t>(r));
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
  CHECK(worst_pooled > 6);  // the test can detect the bias
}

TEST_CASE("adaptive: less error than evenly shared out where pixels differ") {
  std::vector<Lottery> pixels(64, {0.8f});
  for (std::size_t i = 24; i < 32; ++i) pixels[i].chance = 0.05f;
  const int spp = 64, repeats = 400;
  double adaptive = 0, even = 0;
  for (int r = 0; r < repeats; ++r) {
    const Row one = render(pixels, spp, static_cast<std::uint64_t>(r));
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
    CHECK(*std::min_element(more.begin(), more.end()) >= std::max(2, average / 4));
    CHECK(*std::max_element(more.begin(), more.end()) <= 16 * average + 1);
    CHECK(more[200] >= 16 * average - 1);
  }
}

TEST_CASE("adaptive: without noise all pixels have the same, and noise draws samples from the rest") {
  std::vector<PixelEstimate> estimates(20 * 20, {0.5, 0.0});
  for (const int count : second_samples(estimates, 20, 20, 16)) CHECK(count == 12);
  for (std::size_t i = 0; i < estimates.size(); ++i) estimates[i].variance = i % 20 < 10 ? 0.01 : 0.04;
  const std::vector<int> more = second_samples(estimates, 20, 20, 16);
  // Twice the standard deviation gets twice the samples: 8 and 16.
  CHECK(std::abs(more[20 * 10 + 2] - 8) <= 1);
  CHECK(std::abs(more[20 * 10 + 17] - 16) <= 1);
  // The same deviation matters less where the image is bright.
  for (std::size_t i = 0; i < estimates.size(); ++i) estimates[i] = {i % 20 < 10 ? 1.0 : 0.1, 0.04};
  const std::vector<int> dark = second_samples(estimates, 20, 20, 16);
  CHECK(dark[20 * 10 + 17] > 2 * dark[20 * 10 + 2]);
}

RenderOptions adaptive_options(int width, int height, int spp) {
  RenderOptions options;
  options.width = width;
  options.height = height;
  options.spp = spp;
  options.adaptive = true;
  options.sampler = compiler::SamplerKind::Independent;
  return options;
}

// A floor under a ball lamp outside the image, and uniform light above the horizon: only one half is noisy. Light is
// found by hits alone, which few paths have.
compiler::CompiledScene floor_and_sky() {
  return scene_of(R"("camera": {"position": [0, 1, 3], "target": [0, 1, 0], "fov": 60}, "background": [0.5, 0.5, 0.5],
      "materials": {"floor": {"type": "diffuse", "color": [0.6, 0.5, 0.4]},
                    "lamp": {"type": "emissive", "emission": [20, 20, 20]}},
      "objects": [{"type": "plane", "normal": [0, 1, 0], "material": "floor"},
                  {"type": "sphere", "radius": 0.4, "translate": [-2.5, 2, 0.5], "material": "lamp"}])");
}

glm::dvec3 mean_of(const Film& film, PixelRect cell) {
  glm::dvec3 sum(0);
  for (int y = cell.y0; y < cell.y1; ++y) {
    for (int x = cell.x0; x < cell.x1; ++x) sum += film.means(x, y).radiance;
  }
  return sum / static_cast<double>(cell.pixels());
}

TEST_CASE("adaptive: renders have the mean of even ones, and the variance they say", "[render][heavy]") {
  const auto scene = floor_and_sky();
  RenderOptions options = adaptive_options(12, 12, 16);
  options.cut_after = 1;
  options.light_sampling = LightSampling::Lights;
  options.adaptive = false;
  options.spp = test::few(2048);
  const Film even = render(scene, options).film;

  options = adaptive_options(12, 12, 16);
  options.cut_after = 1;
  options.light_sampling = LightSampling::Hits;
  std::array<Sum, 16> cells;
  std::array<Sum, 144> pixels;
  double said = 0;
  const int seeds = test::few(400);
  for (int seed = 0; seed < seeds; ++seed) {
    options.seed = static_cast<std::uint64_t>(seed) + 1;
    const Film film = render(scene, options).film;
    for (int i = 0; i < 16; ++i) {
      const int x = 3 * (i % 4), y = 3 * (i / 4);
      cells[static_cast<std::size_t>(i)].add(mean_of(film, {x, y, x + 3, y + 3}).y);
    }
    for (int i = 0; i < 144; ++i) {
      const PixelMeans pixel = film.means(i % 12, i / 12);
      pixels[static_cast<std::size_t>(i)].add(pixel.radiance.y);
      said += pixel.variance.y / seeds;
    }
  }
  for (int i = 0; i < 16; ++i) {
    const int x = 3 * (i % 4), y = 3 * (i / 4);
    const Sum& cell = cells[static_cast<std::size_t>(i)];
    const double expected = mean_of(even, {x, y, x + 3, y + 3}).y;
    const double sigma = std::sqrt(cell.variance() / cell.n);
    INFO("cell " << i << ": " << cell.mean() << " +- " << sigma << ", evenly " << expected);
    // 2e-3: four standard errors of the even render.
    CHECK(std::abs(cell.mean() - expected) <= 4 * sigma + 2e-3 * expected);
  }
  double found = 0;
  for (const Sum& pixel : pixels) found += pixel.variance();
  INFO("variance " << found << ", said " << said);
  CHECK(said == Approx(found).epsilon(0.1));
}

TEST_CASE("adaptive: the whole budget is used, most of it where the noise is", "[render]") {
  const RenderOptions options = adaptive_options(40, 40, 16);
  std::vector<double> fractions;
  RenderOptions watched = options;
  watched.on_progress = [&](const Progress& progress) { fractions.push_back(progress.fraction); };
  const RenderResult result = render(floor_and_sky(), watched);
  CHECK(result.settings.adaptive);
  CHECK(result.film.layers().variance);
  std::uint32_t all = 0, sky = 0, least = 1000;
  for (int y = 0; y < 40; ++y) {
    for (int x = 0; x < 40; ++x) {
      const std::uint32_t samples = result.film.means(x, y).samples;
      all += samples;
      sky += y < 20 ? samples : 0;
      least = std::min(least, samples);
    }
  }
  CHECK(all == 40 * 40 * 16);
  CHECK(result.stats.primary_rays == all);
  CHECK(least >= 4 + 3);
  INFO(sky << " of " << all << " samples above the horizon");
  CHECK(sky < all * 3 / 8);
  CHECK(std::is_sorted(fractions.begin(), fractions.end()));
  CHECK(fractions.back() == 1);
}

TEST_CASE("adaptive: threads and tiles leave no trace", "[render][threads]") {
  const auto scene = floor_and_sky();
  for (const compiler::SamplerKind sampler : {compiler::SamplerKind::Blue, compiler::SamplerKind::Independent}) {
    RenderOptions options = adaptive_options(37, 21, 9);
    options.sampler = sampler;
    options.layers = kAllLayers;
    options.layers.halves = true;
    options.threads = 1;
    const RenderResult reference = render(scene, options);
    for (const auto& [threads, tile] : {std::array{2, 8}, {3, 17}, {1, 1}}) {
      options.threads = threads;
      options.tile = tile;
      const RenderResult result = render(scene, options);
      INFO(threads << " threads, tiles of " << tile);
      CHECK(result.film.hash() == reference.film.hash());
      CHECK(result.stats.march.rays == reference.stats.march.rays);
    }
    options.adaptive = false;
    CHECK(render(scene, options).film.hash() != reference.film.hash());
  }
}

TEST_CASE("adaptive: with too few samples to share out all pixels have as many", "[render]") {
  const auto scene = floor_and_sky();
  RenderOptions options = adaptive_options(16, 16, kLeastAdaptiveSpp - 1);
  const RenderResult few = render(scene, options);
  CHECK_FALSE(few.settings.adaptive);
  options.adaptive = false;
  CHECK(few.film.hash() == render(scene, options).film.hash());
  options = adaptive_options(16, 16, kLeastAdaptiveSpp);
  CHECK(render(scene, options).settings.adaptive);
}

TEST_CASE("adaptive: stopped after the first stage, a picture is that stage's", "[render]") {
  const auto scene = floor_and_sky();
  RenderOptions options = adaptive_options(16, 16, 16);
  options.threads = 1;
  std::atomic<bool> cancel = false;
  options.cancel = &cancel;
  options.on_progress = [&](const Progress& progress) { cancel = progress.fraction >= 0.25; };
  const RenderResult stopped = render(scene, options);
  CHECK(stopped.stats.end == RenderEnd::Cancelled);
  const RenderResult first = render(scene, [] {
    RenderOptions even = adaptive_options(16, 16, first_samples(16));
    even.adaptive = false;
    even.layers.variance = true;
    return even;
  }());
  CHECK(stopped.film.hash() == first.film.hash());
}

TEST_CASE("adaptive: what was stopped in either stage goes on to the same bits", "[render][threads]") {
  const auto scene = floor_and_sky();
  RenderOptions options = adaptive_options(30, 20, 40);
  options.layers = kAllLayers;
  const RenderResult whole = render(scene, options);
  int second_stages = 0;
  for (const double fraction : {0.05, 0.2, 0.25, 0.3, 0.5, 0.7}) {
    RenderOptions stopping = options;
    std::atomic<bool> cancel = false;
    stopping.cancel = &cancel;
    stopping.on_progress = [&](const Progress& progress) { cancel = progress.fraction >= fraction; };
    const RenderResult stopped = render(scene, stopping);
    REQUIRE(stopped.stats.end == RenderEnd::Cancelled);
    second_stages += stopped.film.stages() == 2;
    RenderOptions going_on = options;
    going_on.resume_from = std::make_shared<PartialRender>(stopped);
    going_on.tile = 7;
    const RenderResult resumed = render(scene, going_on);
    INFO("stopped at " << fraction);
    CHECK(resumed.film.hash() == whole.film.hash());
    CHECK(resumed.covered == whole.covered);
  }
  CHECK(second_stages >= 2);
  CHECK(second_stages <= 4);
}

// The mean square error of renders of the scene, absolute and relative to the brightness. The spread between seeds
// gives the error, because both kinds of render are unbiased.
struct Error {
  double square = 0, relative = 0;
};
Error error_of(const compiler::CompiledScene& scene, RenderOptions options, int seeds) {
  const int width = *options.width, count = width * *options.height;
  std::vector<Sum> pixels(static_cast<std::size_t>(count));
  for (int seed = 0; seed < seeds; ++seed) {
    options.seed = static_cast<std::uint64_t>(seed);
    const Film film = render(scene, options).film;
    for (int i = 0; i < count; ++i) {
      pixels[static_cast<std::size_t>(i)].add(film.means(i % width, i / width).radiance.y);
    }
  }
  Error error;
  for (const Sum& pixel : pixels) {
    error.square += pixel.variance() / count;
    error.relative += pixel.variance() / (pixel.mean() * pixel.mean() + 0.01) / count;
  }
  return error;
}

// A floor below a uniform sky, lit by a caustic through a glass ball: only the few paths that hit the lamp find its
// light.
TEST_CASE("adaptive: a caustic has less error than with as many samples everywhere", "[render][heavy]") {
  const auto scene = scene_of(R"("camera": {"position": [0, 1.2, 6], "target": [0, 1.8, 0], "fov": 50},
      "background": [0.3, 0.3, 0.3],
      "materials": {"floor": {"type": "diffuse", "color": [0.7, 0.7, 0.7]}, "glass": {"type": "transparent"},
                    "lamp": {"type": "emissive", "emission": [30, 30, 30]}},
      "objects": [{"type": "plane", "normal": [0, 1, 0], "material": "floor"},
                  {"type": "sphere", "radius": 0.7, "translate": [0, 0.8, 0], "material": "glass"},
                  {"type": "sphere", "radius": 0.5, "translate": [-2, 6, 0], "material": "lamp"}])");
  RenderOptions options = adaptive_options(40, 24, 32);
  const int seeds = test::few(24);
  const Error adaptive = error_of(scene, options, seeds);
  options.adaptive = false;
  const Error even = error_of(scene, options, seeds);
  INFO("MSE " << adaptive.square << " and evenly " << even.square << ": " << adaptive.square / even.square);
  INFO("relMSE " << adaptive.relative << " and " << even.relative << ": " << adaptive.relative / even.relative);
  CHECK(adaptive.square < 0.8 * even.square);
  CHECK(adaptive.relative < 0.9 * even.relative);
}

}  // namespace
}  // namespace fathom::runtime::adaptive_test
