#include "runtime/film/adaptive.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <functional>
#include <memory>
#include <vector>

#include "runtime/base/tiles.h"
#include "runtime/render.h"
#include "runtime/sampling/sampler.h"
#include "tests/runtime/scenes.h"
#include "tests/support/catch.h"
#include "tests/support/scaled_cases.h"

namespace fathom::runtime::adaptive_test {
namespace {

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
  double error() const { return std::sqrt(variance() / n); }
};

using Ends = std::array<std::uint32_t, 2>;

TEST_CASE("adaptive: judgements double the samples up to half of them, one without a threshold", "[film]") {
  const auto rounds = [](int spp, double threshold) {
    std::vector<std::uint32_t> ends;
    for (std::uint32_t end = 0; (end = next_round(end, spp, threshold)) != 0;) ends.push_back(end);
    return ends;
  };
  CHECK(rounds(400, 0.1) == std::vector<std::uint32_t>{16, 32, 64, 128, 200});
  CHECK(rounds(400, 0) == std::vector<std::uint32_t>{200});
  CHECK(rounds(32, 0.1) == std::vector<std::uint32_t>{16});
  CHECK(rounds(kMinAdaptiveSpp, 0) == std::vector<std::uint32_t>{4});
}

// Adds to the pixels of one half two samples per pixel, 1 - spread and 1 + spread, times the luminance.
void put(Film& film, std::size_t half, const std::function<float(int x)>& spread, std::size_t stage = 0) {
  Film part(film.area(), film.layers());
  for (int y = 0; y < film.height(); ++y) {
    for (int x = 0; x < film.width(); ++x) {
      if (half_of(x, y) != half) continue;
      for (const float value : {1 - spread(x), 1 + spread(x)}) {
        PathSample sample;
        sample.radiance = glm::vec3(value);
        part.add(x, y, sample);
      }
    }
  }
  film.merge(part, stage);
}

TEST_CASE("adaptive: noise is the root of the mean of variance over brightness, of the pixels of a half", "[film]") {
  Film film(4, 1, {.variance = true});
  put(film, 0, [](int x) { return x == 0 ? 1.0f : 0.0f; });
  put(film, 1, [](int) { return 0.5f; });
  // The variance of 0 and 2 is 2, that of their mean is 1.
  CHECK(noise_of(film, {0, 0, 1, 1}, 0) == Approx(std::sqrt(1 / 1.01)));
  CHECK(noise_of(film, {0, 0, 4, 1}, 0) == Approx(std::sqrt(0.5 / 1.01)));
  CHECK(noise_of(film, {0, 0, 4, 1}, 1) == Approx(std::sqrt(0.25 / 1.01)));
  CHECK(image_noise(film, {0, 0, 4, 1}) == Approx(std::sqrt(0.375 / 1.01)));
  CHECK(std::isinf(noise_of(film, {0, 0, 1, 1}, 1)));  // no such pixel: never quiet
}

TEST_CASE("adaptive: each half is judged by the other, and by samples that no mean uses", "[film]") {
  Film film(16, 16, {.variance = true});
  film.add_stage();
  AdaptiveState state;
  state.tiles.resize(1);
  put(film, 0, [](int) { return 0.0f; });  // half 0 is below the threshold: 1 ends
  put(film, 1, [](int) { return 0.9f; });  // half 1 is above the threshold: 0 goes on
  test_convergence(film, 2, 0.1, state);
  CHECK(state.tiles[0].ends == Ends{0, 2});
  // Further samples of half 1 decide when half 0 ends.
  for (int i = 0; i < 200; ++i)
    put(
        film, 1, [](int) { return 0.0f; }, 1);
  CHECK(film.means(3, 3).samples == 2);
  test_convergence(film, 402, 0.1, state);
  CHECK(state.tiles[0].ends == Ends{402, 2});
}

TEST_CASE("adaptive: shares use up the budget, by the root of the other half's deviation", "[film]") {
  Film film(96, 16, {.variance = true});
  AdaptiveState state{2, std::vector<AdaptiveTile>(6)};
  // By half 0 the left of the image has a quarter of the deviation of the right; by half 1 all of it is alike.
  put(film, 0, [](int x) { return x < 48 ? 0.1f : 0.4f; });
  put(film, 1, [](int) { return 0.2f; });
  allocate_samples(film, 64, 0, state);
  std::uint32_t sums[2] = {0, 0};
  for (const AdaptiveTile& tile : state.tiles) {
    for (std::size_t half = 0; half < 2; ++half) sums[half] += tile.ends[half];
    CHECK(tile.ends[0] == 64);  // decided by half 1
  }
  CHECK(sums[1] <= 6 * 64);
  CHECK(sums[1] >= 6 * 64 - 1);
  CHECK(static_cast<double>(state.tiles[5].ends[1]) / state.tiles[0].ends[1] == Approx(2).margin(0.1));
}

TEST_CASE("adaptive: no share is below half or above four times the average, or below what is taken already",
          "[film]") {
  Film film(16 * 40, 16, {.variance = true});
  AdaptiveState state{2, std::vector<AdaptiveTile>(40)};
  for (const std::size_t half : {0, 1}) put(film, half, [](int x) { return x >= 304 && x < 336 ? 0.99f : 1e-4f; });
  allocate_samples(film, 64, 0, state);
  for (const AdaptiveTile& tile : state.tiles) {
    for (const std::uint32_t end : tile.ends) CHECK((end >= 32 && end <= 256));
  }
  CHECK(state.tiles[19].ends == Ends{256, 256});
  AdaptiveState late{60, std::vector<AdaptiveTile>(40)};
  allocate_samples(film, 64, 0, late);
  CHECK(late.tiles[0].ends[0] >= 60);
}

TEST_CASE("adaptive: a share is no larger than the threshold asks for", "[film]") {
  Film film(64, 16, {.variance = true});
  film.add_stage();
  for (const std::size_t half : {0, 1}) put(film, half, [](int) { return 0.1f; });
  AdaptiveState state{2, std::vector<AdaptiveTile>(4)};
  // The variance of the mean of two samples is 0.01: the noise is 0.1, and 4 times as many samples halve it.
  const double noise = noise_of(film, {0, 0, 16, 16}, 0);
  allocate_samples(film, 64, noise / 2, state);
  for (const AdaptiveTile& tile : state.tiles) CHECK((tile.ends[0] == 8 && tile.ends[1] == 8));
}

TEST_CASE("adaptive: without noise all pixels have the same number", "[film]") {
  Film film(64, 32, {.variance = true});
  AdaptiveState state{2, std::vector<AdaptiveTile>(8)};
  for (const std::size_t half : {0, 1}) put(film, half, [](int) { return 0.0f; });
  allocate_samples(film, 16, 0, state);
  for (const AdaptiveTile& tile : state.tiles) CHECK(tile.ends == Ends{16, 16});
}

RenderOptions adaptive_options(int width, int height, int spp, double threshold = 0) {
  RenderOptions options;
  options.width = width;
  options.height = height;
  options.spp = spp;
  options.noise_threshold = threshold;
  options.sampler = compiler::SamplerKind::Independent;
  return options;
}

RenderOptions uniform(RenderOptions options) {
  options.noise_threshold.reset();
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

// 64x48 pixels are 12 tiles, whose samples range from 8 to about 30 per pixel.
TEST_CASE("adaptive: renders have the mean of uniform ones, and the variance they say", "[film][render][heavy]") {
  const auto scene = floor_and_sky();
  const auto options_of = [](LightSampling sampling) {
    RenderOptions options = adaptive_options(64, 48, 16);
    options.max_depth = 1;
    options.light_sampling = sampling;
    return options;
  };
  RenderOptions options = uniform(options_of(LightSampling::Nee));
  options.spp = test::scaled_cases(512);
  const Film truth = render(scene, options).film;
  options = options_of(LightSampling::Bsdf);
  const Tiles tiles({0, 0, 64, 48}, 8);
  std::vector<Sum> cells(48);
  Sum pixel;
  double said = 0;
  const int seeds = test::scaled_cases(200);
  for (int seed = 0; seed < seeds; ++seed) {
    options.seed = static_cast<std::uint64_t>(seed) + 1;
    const Film film = render(scene, options).film;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      cells[i].add(mean_of(film, tiles.at(static_cast<std::int64_t>(i))).y);
    }
    pixel.add(film.means(20, 40).radiance.y);
    said += film.means(20, 40).variance.y / seeds;
  }
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const double expected = mean_of(truth, tiles.at(static_cast<std::int64_t>(i))).y;
    INFO("cell " << i << ": " << cells[i].mean() << " +- " << cells[i].error() << ", uniformly " << expected);
    // 2e-3: four standard errors of the uniform render.
    CHECK(std::abs(cells[i].mean() - expected) <= 4.5 * cells[i].error() + 2e-3 * expected);
  }
  INFO("variance " << pixel.variance() << ", said " << said);
  CHECK(said == Approx(pixel.variance()).epsilon(0.4));
}

// A floor lit by a small bright lamp that few paths hit.
compiler::CompiledScene floor_and_area_light() {
  return scene_of(
      R"("camera": {"position": [0, 1, 0.5], "target": [0, 0, 0], "fov": 60}, "background": [0.2, 0.2, 0.2],
      "materials": {"floor": {"type": "diffuse", "color": [0.5, 0.5, 0.5]},
                    "lamp": {"type": "emissive", "emission": [60, 60, 60]}},
      "objects": [{"type": "plane", "normal": [0, 1, 0], "material": "floor"},
                  {"type": "sphere", "radius": 0.2, "translate": [0, 2, 0], "material": "lamp"}])");
}

// As a control, stopping by the samples that are kept is biased.
TEST_CASE("adaptive: ending below a threshold leaves the mean alone", "[film][render][heavy]") {
  const auto scene = floor_and_area_light();
  constexpr double kThreshold = 0.25;
  constexpr int kMost = 256;
  RenderOptions options = uniform(adaptive_options(8, 8, test::scaled_cases(40000)));
  options.max_depth = 1;
  options.light_sampling = LightSampling::Nee;
  const PixelRect area{0, 0, 8, 8};
  const double expected = mean_of(render(scene, options).film, area).y;
  Sum ours, naive, samples;
  for (int seed = 0; seed < test::scaled_cases(2000); ++seed) {
    options.light_sampling = LightSampling::Bsdf;
    options.seed = static_cast<std::uint64_t>(seed) + 1;
    options.threads = 1;
    options.layers.variance = true;
    for (int spp = 16; spp <= kMost; spp *= 2) {
      options.spp = spp;
      const Film film = render(scene, options).film;
      if (spp < kMost && image_noise(film, film.area()) > 2 * kThreshold) continue;
      naive.add(mean_of(film, area).y);
      break;
    }
    RenderOptions adaptive = options;
    adaptive.spp = kMost;
    adaptive.noise_threshold = kThreshold;
    const Film film = render(scene, adaptive).film;
    ours.add(mean_of(film, area).y);
    samples.add(film.samples(0, 0));
  }
  const auto t = [&](const Sum& sum) { return (sum.mean() - expected) / sum.error(); };
  INFO("expected " << expected << ", ours " << ours.mean() << " (" << t(ours) << " sigma), naive " << naive.mean()
                   << " (" << t(naive) << " sigma), samples " << samples.mean());
  CHECK(std::abs(t(ours)) < 4);
  CHECK(t(naive) < -6);
  CHECK(samples.mean() > 20);  // renders end at different numbers of samples
  CHECK(samples.mean() < 0.9 * kMost);
}

TEST_CASE("adaptive: the whole budget is used, most of it where the noise is", "[film][render]") {
  RenderOptions options = adaptive_options(64, 64, 16);
  std::vector<double> fractions;
  options.on_progress = [&](const Progress& progress) { fractions.push_back(progress.fraction); };
  const RenderResult result = render(floor_and_sky(), options);
  CHECK(result.settings.noise_threshold);
  CHECK(result.film.layers().variance);
  std::uint32_t all = 0, sky = 0, least = 1000;
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      const std::uint32_t samples = result.film.means(x, y).samples;
      all += samples;
      sky += y < 32 ? samples : 0;
      least = std::min(least, samples);
    }
  }
  CHECK(all <= 64 * 64 * 16);
  CHECK(all >= 64 * 64 * 16 - 256);  // less than one sample of a tile's half is left of each half
  CHECK(result.stats.primary_rays == all);
  CHECK(least >= 8);
  INFO(sky << " of " << all << " samples above the horizon");
  CHECK(sky < all * 3 / 8);
  CHECK(std::is_sorted(fractions.begin(), fractions.end()));
  CHECK(fractions.back() == 1);
}

TEST_CASE("adaptive: threads and tiles leave no trace", "[film][render][threads]") {
  const auto scene = floor_and_sky();
  for (const compiler::SamplerKind sampler : {compiler::SamplerKind::Blue, compiler::SamplerKind::Independent}) {
    for (const double threshold : {0.0, 0.08}) {
      RenderOptions options = adaptive_options(50, 34, 96, threshold);
      options.sampler = sampler;
      options.light_sampling = LightSampling::Bsdf;
      options.layers = kAllLayers;
      options.layers.halves = true;
      options.threads = 1;
      const RenderResult reference = render(scene, options);
      for (const auto& [threads, tile] : {std::array{2, 8}, {3, 17}}) {
        options.threads = threads;
        options.tile = tile;
        const RenderResult result = render(scene, options);
        INFO(threads << " threads, tiles of " << tile << ", threshold " << threshold);
        CHECK(result.film.hash() == reference.film.hash());
        CHECK(result.adaptive == reference.adaptive);
        CHECK(result.covered == reference.covered);
      }
      CHECK(render(scene, uniform(options)).film.hash() != reference.film.hash());
    }
  }
}

TEST_CASE("adaptive: quiet tiles end early, and a render below its threshold says so", "[film][render]") {
  RenderOptions options = adaptive_options(48, 32, 256, 1e6);
  const RenderResult quiet = render(floor_and_sky(), options);
  CHECK(quiet.stats.end == RenderEnd::Noise);
  CHECK(quiet.stats.primary_rays == 48u * 32u * 16u);
  options.noise_threshold = 1e-9;
  const RenderResult all = render(floor_and_sky(), options);
  CHECK(all.stats.end == RenderEnd::Done);
  CHECK(all.film.samples() > 48u * 32u * 250u);
}

TEST_CASE("adaptive: with too few samples to share out all pixels have as many", "[film][render]") {
  const auto scene = floor_and_sky();
  RenderOptions options = adaptive_options(16, 16, kMinAdaptiveSpp - 1);
  const RenderResult scaled_cases = render(scene, options);
  CHECK_FALSE(scaled_cases.settings.noise_threshold);
  CHECK(scaled_cases.film.hash() == render(scene, uniform(options)).film.hash());
  options = adaptive_options(16, 16, kMinAdaptiveSpp);
  CHECK(render(scene, options).settings.noise_threshold);
  options.uniform = true;
  CHECK_FALSE(render(scene, options).settings.noise_threshold);
}

TEST_CASE("adaptive: an interrupted render goes on to the same bits", "[film][render][threads][released]") {
  const auto scene = floor_and_sky();
  for (const double threshold : {0.0, 0.08}) {
    RenderOptions options = adaptive_options(50, 34, 96, threshold);
    options.light_sampling = LightSampling::Bsdf;
    options.layers = kAllLayers;
    options.layers.halves = true;
    const RenderResult whole = render(scene, options);
    int after_judgement = 0;
    for (int stop = 1; stop < 2500; stop += 1 + stop / 2) {
      RenderOptions stopping = options;
      std::atomic<bool> cancel = false;
      stopping.cancel = &cancel;
      stopping.tile = 5;
      int units = 0;
      stopping.on_progress = [&](const Progress&) { cancel = ++units >= stop; };
      const RenderResult stopped = render(scene, stopping);
      after_judgement += stopped.adaptive.tested_spp > 0 && stopped.stats.end == RenderEnd::Cancelled;
      RenderOptions going_on = options;
      REQUIRE(can_resume(stopped, stopped.settings));
      going_on.resume_from = std::make_shared<PartialRender>(stopped);
      going_on.threads = 1 + stop % 3;
      const RenderResult resumed = render(scene, going_on);
      INFO("after " << stop << " units, threshold " << threshold);
      CHECK(resumed.film.hash() == whole.film.hash());
      CHECK(resumed.adaptive == whole.adaptive);
      CHECK(resumed.covered == whole.covered);
    }
    CHECK(after_judgement >= 2);
  }
}

double relative_error(const Film& film, const Film& truth) {
  double sum = 0;
  for (int y = 0; y < film.height(); ++y) {
    for (int x = 0; x < film.width(); ++x) {
      const glm::dvec3 is = film.means(x, y).radiance, was = truth.means(x, y).radiance;
      for (int i = 0; i < 3; ++i) sum += (is[i] - was[i]) * (is[i] - was[i]) / (was[i] * was[i] + 0.01);
    }
  }
  return sum / (3.0 * static_cast<double>(film.area().pixels()));
}

// A floor below a uniform sky, lit by a caustic through a glass ball: only the few paths that hit the lamp find its
// light.
TEST_CASE("adaptive: a caustic has less error than with as many samples everywhere", "[film][render][heavy]") {
  const auto scene = scene_of(R"("camera": {"position": [0, 1.2, 6], "target": [0, 1.8, 0], "fov": 50},
      "background": [0.3, 0.3, 0.3],
      "materials": {"floor": {"type": "diffuse", "color": [0.7, 0.7, 0.7]}, "glass": {"type": "transparent"},
                    "lamp": {"type": "emissive", "emission": [30, 30, 30]}},
      "objects": [{"type": "plane", "normal": [0, 1, 0], "material": "floor"},
                  {"type": "sphere", "radius": 0.7, "translate": [0, 0.8, 0], "material": "glass"},
                  {"type": "sphere", "radius": 0.5, "translate": [-2, 6, 0], "material": "lamp"}])");
  RenderOptions options = adaptive_options(128, 80, 32);
  RenderOptions truth_options = uniform(options);
  truth_options.spp = test::scaled_cases(4096);
  truth_options.seed = 999;
  const Film truth = render(scene, truth_options).film;
  double adaptive = 0, even = 0;
  for (int seed = 0; seed < test::scaled_cases(8); ++seed) {
    options.seed = static_cast<std::uint64_t>(seed);
    adaptive += relative_error(render(scene, options).film, truth);
    even += relative_error(render(scene, uniform(options)).film, truth);
  }
  INFO("relMSE " << adaptive << " and uniformly " << even << ": " << adaptive / even);
  CHECK(adaptive < 0.9 * even);
}

}  // namespace
}  // namespace fathom::runtime::adaptive_test
