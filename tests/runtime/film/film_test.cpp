#include "runtime/film/film.h"

#include <array>
#include <cmath>
#include <vector>

#include "runtime/render.h"
#include "runtime/sampling/sampler.h"
#include "tests/runtime/scenes.h"
#include "tests/support/catch.h"

namespace fathom::runtime::film_test {
namespace {

PathSample sample_of(float value, double depth) {
  PathSample sample;
  sample.radiance = glm::vec3(value, 2 * value, 0);
  sample.hit = depth > 0;
  sample.albedo = glm::vec3(0.5f);
  sample.normal = glm::vec3(0, 1, 0);
  sample.depth = depth;
  return sample;
}

TEST_CASE("film: means over all samples, depth over those that hit", "[film]") {
  Film film(2, 1);
  CHECK(film.add(1, 0, sample_of(1, 4)));
  CHECK(film.add(1, 0, sample_of(3, 0)));
  const PixelMeans means = film.means(1, 0);
  CHECK(means.radiance == glm::dvec3(2, 4, 0));
  CHECK(means.albedo == glm::dvec3(0.25));
  CHECK(means.depth == 4);
  CHECK(means.hits == 1);
  CHECK(means.samples == 2);
  CHECK(film.means(0, 0).samples == 0);
}

TEST_CASE("film: layers that are not kept are zero and change nothing of the others", "[film]") {
  PathSample sample = sample_of(1, 4);
  sample.evaluations = 30;
  sample.instructions = 600;
  Film bare(1, 1, {.first_hit = false, .cost = false}), usual(1, 1), full(1, 1, {.first_hit = true, .cost = true});
  for (Film* film : {&bare, &usual, &full}) {
    CHECK(film->add(0, 0, sample));
    sample.evaluations = 10;
    CHECK(film->add(0, 0, sample));
    sample.evaluations = 30;
    CHECK(film->means(0, 0).radiance == glm::dvec3(1, 2, 0));
    CHECK(film->means(0, 0).hits == 2);
  }
  CHECK(bare.means(0, 0).albedo == glm::dvec3(0));
  CHECK(bare.means(0, 0).depth == 0);
  CHECK(usual.means(0, 0).depth == 4);
  CHECK(usual.means(0, 0).evaluations == 0);
  CHECK(full.means(0, 0).evaluations == 20);
  CHECK(full.means(0, 0).instructions == 600);
  CHECK(full.hash() == usual.hash());  // the hash of the image does not include the cost
  CHECK(bare.hash() != usual.hash());
}

TEST_CASE("film: the order of samples leaves no trace", "[film]") {
  Film forwards(1, 1), backwards(1, 1);
  for (int i = 0; i < 1000; ++i) {
    forwards.add(0, 0, sample_of(1.0f / static_cast<float>(i + 3), i));
    backwards.add(0, 0, sample_of(1.0f / static_cast<float>(1002 - i), 999 - i));
  }
  CHECK(forwards.hash() == backwards.hash());
  CHECK(forwards.hash() != Film(1, 1).hash());
}

PathSample numbered(std::uint32_t number) {
  PathSample sample = sample_of(0.1f * static_cast<float>(number * 7 % 11), number % 3);
  sample.number = number;
  sample.position = glm::dvec3(number, -0.5 * number, 1e6);
  sample.surface = number * 5 % 7;
  sample.material = number * 3 % 4;
  sample.evaluations = number;
  return sample;
}

TEST_CASE("film: every layer is the same in any order", "[film]") {
  constexpr std::uint32_t kSamples = 200;
  Film forwards(1, 1, kAllLayers), backwards(1, 1, kAllLayers), mixed(1, 1, kAllLayers);
  for (std::uint32_t i = 0; i < kSamples; ++i) {
    forwards.add(0, 0, numbered(i));
    backwards.add(0, 0, numbered(kSamples - 1 - i));
    mixed.add(0, 0, numbered(i * 77 % kSamples));
  }
  CHECK(forwards.hash() == backwards.hash());
  CHECK(forwards.hash() == mixed.hash());
  const PixelMeans means = mixed.means(0, 0);
  // Sample 0 hit nothing (its depth is 0 % 3), sample 1 did.
  CHECK(means.surface_id == 5 + 1);
  CHECK(means.material_id == 3 + 1);
  CHECK(means.position.z == 1e6);
  CHECK(means.evaluations == (kSamples - 1) / 2.0);
}

TEST_CASE("film: ids and positions are those of samples that hit, 0 without any", "[film]") {
  Film film(1, 1, kAllLayers);
  film.add(0, 0, sample_of(1, 0));
  CHECK(film.means(0, 0).surface_id == 0);
  CHECK(film.means(0, 0).material_id == 0);
  CHECK(film.means(0, 0).position == glm::dvec3(0));
  PathSample hit = sample_of(1, 2);
  hit.position = {1, 2, 3};
  film.add(0, 0, hit);
  CHECK(film.means(0, 0).surface_id == 1);
  CHECK(film.means(0, 0).position == glm::dvec3(1, 2, 3));
  CHECK(Film(1, 1).means(0, 0).surface_id == 0);
}

TEST_CASE("film: the variance of the mean, dark or bright", "[film]") {
  for (const double scale : {1e-5, 1.0, 1e5}) {
    Film film(1, 1, {.variance = true});
    // The sample variance s^2 of 1, 2, ..., n is n (n + 1) / 12.
    constexpr int kSamples = 100;
    PathSample sample;
    for (int i = 1; i <= kSamples; ++i) {
      sample.radiance = glm::vec3(static_cast<float>(scale * i));
      film.add(0, 0, sample);
    }
    const double expected = scale * scale * (kSamples + 1) / 12.0;
    CHECK(film.means(0, 0).variance.x == Approx(expected).epsilon(1e-4));  // the film rounds terms to 2^-32
  }
  Film even(1, 1, {.variance = true});
  PathSample sample;
  sample.radiance = glm::vec3(0.1f, 1e-4f, 1000.1f);
  for (int i = 0; i < 1000; ++i) even.add(0, 0, sample);
  CHECK(even.means(0, 0).variance == glm::dvec3(0));  // exactly 0
  Film one(1, 1, {.variance = true});
  one.add(0, 0, sample);
  CHECK(one.means(0, 0).variance == glm::dvec3(0));
}

// The layer is the true variance for independent samples. For samples that avoid each other, the layer is an upper
// bound, because it assumes independence. Regression: the layer's description did not say so.
TEST_CASE("film: the variance layer against the variance between seeds", "[film][render][released]") {
  const auto scene =
      scene_of(R"("camera": {"position": [0, 1, 3], "target": [0, 0.3, 0]}, "background": [0.2, 0.3, 0.5],
      "materials": {"lamp": {"type": "emissive", "emission": [8, 8, 8]}},
      "objects": [{"type": "plane", "normal": [0, 1, 0]}, {"type": "sphere", "radius": 0.5, "translate": [0, 0.5, 0]},
                  {"type": "sphere", "radius": 0.3, "translate": [1, 2, 1], "material": "lamp"}])");
  const auto ratio_of = [&](SamplerKind kind) {
    constexpr int kSide = 12, kSeeds = 32;
    RenderOptions options;
    options.width = options.height = kSide;
    options.spp = 16;
    options.sampler = kind;
    options.layers.variance = true;
    std::array<double, kSide * kSide> sum{}, squares{};
    double layer = 0, measured = 0;
    for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
      options.seed = seed;
      const Film film = render(scene, options).film;
      for (std::size_t i = 0; i < sum.size(); ++i) {
        const PixelMeans means = film.means(static_cast<int>(i) % kSide, static_cast<int>(i) / kSide);
        layer += means.variance.y / kSeeds;
        sum[i] += means.radiance.y;
        squares[i] += means.radiance.y * means.radiance.y;
      }
    }
    for (std::size_t i = 0; i < sum.size(); ++i) measured += (squares[i] - sum[i] * sum[i] / kSeeds) / (kSeeds - 1);
    return layer / measured;
  };
  CHECK(ratio_of(SamplerKind::Independent) == Approx(1).margin(0.15));
  for (const SamplerKind kind : {SamplerKind::Sobol, SamplerKind::Blue}) {
    const double ratio = ratio_of(kind);
    CAPTURE(ratio);
    CHECK(ratio > 1);
    CHECK(ratio < 8);
  }
}

TEST_CASE("film: squares beyond whole numbers are full, and variance stays finite", "[film]") {
  Film film(1, 1, {.variance = true});
  PathSample sample;
  sample.radiance = glm::vec3(3e9f, 1e9f, 0);
  for (int i = 0; i < 8; ++i) CHECK_FALSE(film.add(0, 0, sample));
  CHECK(std::isfinite(film.means(0, 0).variance.x));
  CHECK(film.means(0, 0).variance.y >= 0);
  CHECK(film.means(0, 0).variance.z == 0);
}

TEST_CASE("film: a part of a picture takes the picture's pixels", "[film]") {
  Film film(PixelRect{3, 2, 5, 4});
  CHECK(film.width() == 2);
  CHECK(film.height() == 2);
  film.add(4, 3, sample_of(1, 4));
  CHECK(film.means(4, 3).hits == 1);
  CHECK(film.means(3, 2).samples == 0);
}

TEST_CASE("film: a full sum stays full and says so", "[film]") {
  Film film(1, 1);
  CHECK(film.add(0, 0, sample_of(1e9f, 0)));
  CHECK_FALSE(film.add(0, 0, sample_of(2e9f, 0)));
  CHECK(film.means(0, 0).radiance.x == Approx(0x1p31 / 2));
  CHECK_FALSE(film.add(0, 0, sample_of(1e30f, 0)));
  CHECK(film.means(0, 0).radiance.x == Approx(0x1p31 / 3));
}

// Adds red radiance 1, 2, ..., n as the samples from number `first` on.
void add_count(Film& film, std::uint32_t first, int n) {
  for (int i = 1; i <= n; ++i) {
    PathSample sample = sample_of(static_cast<float>(i), 3);
    sample.number = first + static_cast<std::uint32_t>(i - 1);
    sample.surface = sample.number;
    film.add(0, 0, sample);
  }
}

FilmLayers every_layer() {
  FilmLayers layers = kAllLayers;
  layers.halves = true;
  return layers;
}

TEST_CASE("film: films of parts add up to the film of the whole, in any order", "[film]") {
  constexpr std::uint32_t kSamples = 60;
  const PixelRect area{2, 1, 7, 5}, left{2, 1, 4, 5}, right{4, 1, 7, 5};
  Film whole(area, every_layer());
  // Left and right halves, each split into the samples below 20, even ones and odd ones.
  std::vector<Film> parts;
  for (int i = 0; i < 6; ++i) parts.emplace_back(i % 2 == 0 ? left : right, every_layer());
  for (int y = area.y0; y < area.y1; ++y) {
    for (int x = area.x0; x < area.x1; ++x) {
      for (std::uint32_t s = 0; s < kSamples; ++s) {
        const PathSample sample = numbered(s + static_cast<std::uint32_t>(x * y));
        whole.add(x, y, sample);
        parts[(s < 20 ? 0 : s % 2 == 0 ? 2 : 4) + (x < left.x1 ? 0 : 1)].add(x, y, sample);
      }
    }
  }
  for (const std::array<std::size_t, 6>& order : {std::array<std::size_t, 6>{0, 1, 2, 3, 4, 5}, {5, 3, 1, 0, 2, 4}}) {
    Film sum(area, every_layer());
    for (const std::size_t i : order) CHECK(sum.merge(parts[i]));
    CHECK(sum.hash() == whole.hash());
    CHECK(sum.means(3, 2).evaluations == whole.means(3, 2).evaluations);
    CHECK(sum.samples() == area.pixels() * kSamples);
  }
  parts[0].restart(right);
  CHECK(parts[0].hash() == Film(right, every_layer()).hash());
}

TEST_CASE("film: merging fills a sum and says so", "[film]") {
  Film sum(1, 1), part(1, 1);
  part.add(0, 0, sample_of(1e9f, 0));
  CHECK(sum.merge(part));
  CHECK_FALSE(sum.merge(part));
  CHECK_FALSE(sum.merge(part));
  CHECK(sum.means(0, 0).radiance.y == Approx(0x1p31 / 3));
}

// Merges a film of `n` samples into a stage.
void merge_count(Film& film, std::size_t stage, std::uint32_t first, int n) {
  Film part(1, 1, film.layers());
  add_count(part, first, n);
  film.merge(part, stage);
}

TEST_CASE("film: no mean uses the samples of the second stage", "[film]") {
  FilmLayers layers = kAllLayers;
  layers.halves = true;
  Film film(1, 1, layers);
  film.add_stage();
  merge_count(film, 0, 0, 4);
  const PixelMeans means = film.means(0, 0);
  CHECK(means.radiance.x == 2.5);
  merge_count(film, 1, 4, 9);
  const PixelMeans same = film.means(0, 0);
  CHECK(same.radiance == means.radiance);
  CHECK(same.variance == means.variance);
  CHECK((same.halves[0] == means.halves[0] && same.halves[1] == means.halves[1]));
  CHECK((same.samples == 4 && same.hits == 4 && same.surface_id == 1 && film.samples() == 4));
  // The mean of 1..4 and 1..9, and its variance, by hand.
  const RadianceMeans all = film.all_radiance(0, 0);
  CHECK(all.samples == 13);
  CHECK(all.radiance.x == Approx(55.0 / 13));
  CHECK(all.variance.x == Approx((315 - 55.0 * 55 / 13) / 12 / 13));
}

TEST_CASE("film: the stage of a sample leaves a trace", "[film]") {
  const auto film_of = [](std::array<std::uint32_t, 4> numbers) {
    Film film(1, 1, kAllLayers);
    film.add_stage();
    for (std::size_t i = 0; i < 4; ++i) {
      Film part(1, 1, kAllLayers);
      part.add(0, 0, numbered(numbers[i]));
      film.merge(part, i / 2);
    }
    return film.hash();
  };
  CHECK(film_of({1, 2, 3, 4}) == film_of({2, 1, 4, 3}));
  CHECK(film_of({1, 2, 3, 4}) != film_of({1, 3, 2, 4}));
}

}  // namespace
}  // namespace fathom::runtime::film_test
