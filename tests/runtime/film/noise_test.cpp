#include "runtime/film/noise.h"

#include <array>
#include <atomic>
#include <catch2/catch.hpp>
#include <cmath>
#include <memory>
#include <vector>

#include "runtime/base/tiles.h"
#include "runtime/render.h"
#include "runtime/sampling/sampler.h"
#include "tests/runtime/scenes.h"
#include "tests/support/effort.h"

namespace fathom::runtime::noise_test {
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
  double error() const { return std::sqrt((squares - sum * sum / n) / (n - 1) / n); }
};

// A floor lit by a small bright lamp that few paths hit.
compiler::CompiledScene floor_and_lamp() {
  return scene_of(
      R"("camera": {"position": [0, 1, 0.5], "target": [0, 0, 0], "fov": 60}, "background": [0.2, 0.2, 0.2],
      "materials": {"floor": {"type": "diffuse", "color": [0.5, 0.5, 0.5]},
                    "lamp": {"type": "emissive", "emission": [60, 60, 60]}},
      "objects": [{"type": "plane", "normal": [0, 1, 0], "material": "floor"},
                  {"type": "sphere", "radius": 0.2, "translate": [0, 2, 0], "material": "lamp"}])");
}

RenderOptions options_of(int width, int height, int spp) {
  RenderOptions options;
  options.width = width;
  options.height = height;
  options.spp = spp;
  options.sampler = compiler::SamplerKind::Independent;
  options.cut_after = 1;
  return options;
}

double mean_of(const Film& film) {
  double sum = 0;
  const PixelRect area = film.area();
  for (int y = area.y0; y < area.y1; ++y) {
    for (int x = area.x0; x < area.x1; ++x) sum += film.means(x, y).radiance.y;
  }
  return sum / static_cast<double>(area.pixels());
}

TEST_CASE("noise: judgements double the samples from the least to the most") {
  std::vector<std::uint32_t> ends;
  for (std::uint32_t end = next_end(0, 16, 100); end != 0; end = next_end(end, 16, 100)) ends.push_back(end);
  CHECK(ends == std::vector<std::uint32_t>{8, 16, 32, 50});
  CHECK(next_end(0, 16, 16) == 8);
  CHECK(next_end(8, 16, 17) == 0);
  CHECK(next_end(0, 1, 4) == 2);
  CHECK(next_end(0, 5, 17) == 3);  // in pairs, one sample for each half
}

TEST_CASE("noise: it is the root of the mean of variance over brightness, of a picture of two halves") {
  Film film(2, 1, {.variance = true});
  for (const float value : {0.0f, 2.0f}) {
    PathSample sample;
    sample.radiance = glm::vec3(value);
    film.add(0, 0, sample);
    sample.radiance = glm::vec3(0.5f);
    film.add(1, 0, sample);
  }
  // The variance of 0 and 2 is 2, that of their mean is 1.
  CHECK(noise_of(film, {0, 0, 1, 1}, {0}) == Approx(std::sqrt(1 / (2 * 1.01))));
  CHECK(noise_of(film, {0, 0, 2, 1}, {0}) == Approx(std::sqrt(1 / (2 * 1.01) / 2)));
}

TEST_CASE("noise: each half is decided by the other, and what is no longer counted is judged on") {
  Film film(16, 16, {.variance = true});
  film.begin_halves();
  NoiseState state;
  state.tiles.resize(1);
  const auto put = [&](std::size_t stage, float spread) {
    Film part(16, 16, {.variance = true});
    for (int i = 0; i < 256; ++i) {
      for (const float value : {1 - spread, 1 + spread}) {
        PathSample sample;
        sample.radiance = glm::vec3(value);
        part.add(i % 16, i / 16, sample);
      }
    }
    film.merge(part, stage);
  };
  put(0, 0.0f);  // half A is below the noise limit: B ends
  put(1, 0.9f);  // half B is above the noise limit: A goes on
  CHECK(judge(film, 2, 0.1, state) == 1);
  CHECK(state.tiles[0].ends == std::array<std::uint32_t, 2>{0, 2});
  for (int i = 0; i < 200; ++i) put(3, 0.0f);  // B's new samples no longer count, but decide when A ends
  CHECK(film.means(3, 3).samples == 4);
  CHECK(judge(film, 402, 0.1, state) == 0);
  CHECK(state.tiles[0].ends == std::array<std::uint32_t, 2>{402, 2});
}

// The mean of adaptive stopping is within four standard errors of the truth. As a control, stopping by the samples
// that are kept is biased.
TEST_CASE("noise: stopping leaves the mean alone, which stopping by one's own samples does not", "[render][heavy]") {
  const auto scene = floor_and_lamp();
  RenderOptions options = options_of(8, 8, test::few(40000));
  options.light_sampling = LightSampling::Lights;
  const double expected = mean_of(render(scene, options).film);
  constexpr double kLimit = 0.25;
  constexpr int kMost = 256;
  Sum ours, naive, samples;
  const int seeds = test::few(2000);
  for (int seed = 0; seed < seeds; ++seed) {
    options = options_of(8, 8, kMost);
    options.light_sampling = LightSampling::Hits;
    options.seed = static_cast<std::uint64_t>(seed) + 1;
    options.threads = 1;
    options.layers.variance = true;
    for (int spp = 16; spp <= kMost; spp *= 2) {
      options.spp = spp;
      const Film film = render(scene, options).film;
      if (spp < kMost && noise_of(film, film.area(), {0}) > kLimit * std::sqrt(2.0)) continue;
      naive.add(mean_of(film));
      break;
    }
    options.spp = kMost;
    options.noise = kLimit;
    const Film film = render(scene, options).film;
    ours.add(mean_of(film));
    samples.add(film.samples(0, 0));
  }
  const auto t = [&](const Sum& sum) { return (sum.mean() - expected) / sum.error(); };
  INFO("expected " << expected << ", ours " << ours.mean() << " (" << t(ours) << " sigma), naive " << naive.mean()
                   << " (" << t(naive) << " sigma), samples " << samples.mean());
  CHECK(std::abs(t(ours)) < 4);
  CHECK(t(naive) < -6);
  CHECK(samples.mean() > 20);  // renders stop at different numbers of samples
  CHECK(samples.mean() < 0.9 * kMost);
}

RenderOptions noisy_options() {
  RenderOptions options = options_of(50, 34, 96);
  options.sampler = compiler::SamplerKind::Blue;
  options.noise = 0.08;
  options.layers = kAllLayers;
  options.layers.halves = true;
  return options;
}

// Half of the image is uniformly lit by the background, so the tiles' noise differs.
compiler::CompiledScene lamp_and_sky() {
  return scene_of(R"("camera": {"position": [0, 1, 3], "target": [0, 1, 0], "fov": 60}, "background": [0.5, 0.5, 0.5],
      "materials": {"lamp": {"type": "emissive", "emission": [20, 20, 20]}},
      "objects": [{"type": "plane", "normal": [0, 1, 0]},
                  {"type": "sphere", "radius": 0.4, "translate": [-2.5, 2, 0.5], "material": "lamp"}])");
}

TEST_CASE("noise: quiet tiles get the least, noisy ones the most, and threads and tiles leave no trace",
          "[render][threads]") {
  const auto scene = lamp_and_sky();
  RenderOptions options = noisy_options();
  options.light_sampling = LightSampling::Hits;
  options.threads = 1;
  const RenderResult reference = render(scene, options);
  CHECK(reference.film.samples(40, 3) == 16);
  CHECK(reference.film.samples(3, 30) > 16);
  CHECK(reference.film.samples() < 50u * 34u * 96u);
  for (const auto& [threads, tile] : {std::array{2, 8}, {3, 17}, {2, 64}}) {
    options.threads = threads;
    options.tile = tile;
    const RenderResult result = render(scene, options);
    CHECK(result.film.hash() == reference.film.hash());
    CHECK(result.noise == reference.noise);
    CHECK(result.covered == reference.covered);
  }
  options.noise = 100;
  const RenderResult quiet = render(scene, options);
  CHECK(quiet.stats.end == RenderEnd::Noise);
  CHECK(quiet.stats.primary_rays == 50u * 34u * 16u);
  options.noise = 1e-9;
  options.min_spp = 32;
  const RenderResult all = render(scene, options);
  CHECK(all.stats.end == RenderEnd::Done);
  CHECK(all.film.samples(3, 30) == 96);
}

TEST_CASE("noise: samples come by twos, no fewer than the least, and progress ends at all of them", "[render]") {
  RenderOptions options = noisy_options();
  options.spp = 17;
  options.min_spp = 5;
  double last = 0;
  options.on_progress = [&](const Progress& progress) { last = progress.fraction; };
  for (const auto& [noise, samples] : {std::pair{1e10, 6u}, {1e-9, 16u}}) {
    options.noise = noise;
    const RenderResult result = render(lamp_and_sky(), options);
    CHECK(result.film.samples(3, 30) == samples);
    CHECK(last == 1);
  }
}

TEST_CASE("noise: what was stopped at any moment goes on to the same bits", "[render][threads][released]") {
  const auto scene = lamp_and_sky();
  RenderOptions options = noisy_options();
  options.light_sampling = LightSampling::Hits;
  const RenderResult whole = render(scene, options);
  int stopped_after_judgement = 0;
  for (int stop = 1; stop < 2500; stop = stop * 2 + 1) {
    RenderOptions stopping = options;
    std::atomic<bool> cancel = false;
    stopping.cancel = &cancel;
    stopping.tile = 5;
    int units = 0;
    stopping.on_progress = [&](const Progress&) { cancel = ++units >= stop; };
    const RenderResult stopped = render(scene, stopping);
    stopped_after_judgement += stopped.noise.judged > 0;
    RenderOptions going_on = options;
    REQUIRE(can_resume(stopped, stopped.settings));
    going_on.resume_from = std::make_shared<PartialRender>(stopped);
    going_on.threads = 1 + stop % 3;
    const RenderResult resumed = render(scene, going_on);
    INFO("after " << stop << " units");
    CHECK(resumed.film.hash() == whole.film.hash());
    CHECK(resumed.noise == whole.noise);
    CHECK(resumed.covered == whole.covered);
  }
  CHECK(stopped_after_judgement >= 2);
}

}  // namespace
}  // namespace fathom::runtime::noise_test
