// Whole pictures against light that is known in closed form, and the ways to find light against each other.
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <glm/geometric.hpp>

#include "runtime/render.h"
#include "tests/runtime/estimate.h"
#include "tests/runtime/scenes.h"
#include "tests/support/effort.h"
#include "tests/support/light_scenes.h"

namespace fathom::runtime {
namespace {

using tests::LightScene;

RenderOptions square(int side, int spp) {
  RenderOptions options;
  options.width = side;
  options.height = side;
  options.spp = spp;
  options.sampler = compiler::SamplerKind::Independent;  // so that the pixels' spread tells the error
  return options;
}

constexpr std::array kEveryWay = {LightSampling::Both, LightSampling::Lights, LightSampling::Hits};

// Within 4 standard errors, which are at most `error` of the value: with as many checks as this file has, one in a
// thousand correct renderers would fail.
void expect(const LightScene& scene, RenderOptions options, double error) {
  const RenderResult result = render(scene_of(scene.json), options);
  const Estimate found = estimate(result.film);
  INFO(scene.name << ": " << found.mean << " +- " << found.sigma << ", in closed form " << scene.radiance);
  CHECK(std::abs(found.mean - scene.radiance) <= 4 * found.sigma + 2e-5 * scene.radiance);
  CHECK(found.sigma <= error * scene.radiance);
  CHECK(result.stats.march.invalid + result.stats.dropped_samples == 0);
}

TEST_CASE("light: closed rooms, however paths end", "[render][light]") {
  for (const double albedo : {0.5, 0.8, 0.9}) {
    for (const int bounces : {0, 2, 5}) {
      RenderOptions options = square(24, test::few(64));
      options.bounces = bounces;
      expect(tests::closed_room(albedo), options, 2e-2);
    }
  }
  expect(tests::closed_room(0.5, R"("type": "box", "half_size": [1, 1, 1])"), square(24, test::few(64)), 2e-2);
}

TEST_CASE("light: what absorbs nothing vanishes in an even light", "[render][light]") {
  for (const char* material : {R"({"type": "diffuse", "color": [1, 1, 1]})", R"({"type": "specular"})",
                               R"({"type": "transparent"})", R"({"type": "transparent", "ior": 2.4})"}) {
    for (const LightSampling way : kEveryWay) {
      RenderOptions options = square(16, test::few(64));
      options.light_sampling = way;
      expect(tests::in_even_light(material), options, 1e-2);
    }
  }
}

TEST_CASE("light: irradiance under lamps of every shape, in every way", "[render][light]") {
  const LightScene scenes[] = {tests::under_ball(0.5, 0, 2), tests::under_ball(0.3, 1, 0.8),
                               tests::under_disc(0.5, 1), tests::under_rectangle(0.4, 0.3, 0, 1),
                               tests::under_rectangle(0.5, 0.2, 0.3, 0.6)};
  for (const LightScene& scene : scenes) {
    for (const LightSampling way : kEveryWay) {
      INFO("way " << static_cast<int>(way));
      RenderOptions options = square(32, test::few(way == LightSampling::Hits ? 256 : 64));
      options.light_sampling = way;
      expect(scene, options, way == LightSampling::Hits ? 2e-2 : 5e-3);
    }
  }
}

TEST_CASE("light: a cavity gathers light by many bounces", "[render][light]") {
  for (const double albedo : {0.5, 0.9}) expect(tests::cavity(albedo, 40), square(24, test::few(128)), 3e-2);
}

TEST_CASE("light: a slab of glass passes 1 - R over 1 + R", "[render][light]") {
  expect(tests::slab(), square(24, test::few(64)), 1e-2);
}

TEST_CASE("light: Lambert's ball at every phase", "[render][light]") {
  for (const double degrees : {0.0, 60.0, 120.0}) {
    RenderOptions options = square(192, 4);
    const RenderResult result = render(scene_of(tests::moon(degrees).json), options);
    const Estimate found = estimate(result.film);
    INFO(degrees << " degrees: " << found.mean << ", in closed form " << tests::moon(degrees).radiance);
    CHECK(found.mean == Approx(tests::moon(degrees).radiance).epsilon(3e-3));
  }
}

// Of cells of the picture, by Welch's test: the largest deviation in standard errors of both.
double worst_difference(const Film& a, const Film& b, int cell) {
  double worst = 0;
  for (int y = 0; y + cell <= a.height(); y += cell) {
    for (int x = 0; x + cell <= a.width(); x += cell) {
      const auto of = [&](const Film& film) {
        double sum = 0, squares = 0;
        for (int i = 0; i < cell * cell; ++i) {
          const double value = film.means(x + i % cell, y + i / cell).radiance.y;
          sum += value, squares += value * value;
        }
        const double n = cell * cell, mean = sum / n;
        return std::array{mean, (squares / n - mean * mean) / (n - 1)};
      };
      const auto [mean_a, variance_a] = of(a);
      const auto [mean_b, variance_b] = of(b);
      worst = std::max(worst, std::abs(mean_a - mean_b) / std::sqrt(variance_a + variance_b + 1e-12));
    }
  }
  return worst;
}

TEST_CASE("light: looking for lights, hitting them and both give one picture", "[render][light][heavy]") {
  const auto scene = scene_of(tests::kLampRoom);
  RenderOptions options = square(64, 400);
  const RenderResult both = render(scene, options);
  for (const LightSampling way : {LightSampling::Lights, LightSampling::Hits}) {
    options.light_sampling = way;
    options.seed = 1;
    options.spp = way == LightSampling::Hits ? 1600 : 400;
    INFO("way " << static_cast<int>(way));
    // 64 cells; pixels within a cell differ by more than noise, which only widens the errors. 4.5 standard errors
    // come about once in 2000 such pictures.
    CHECK(worst_difference(both.film, render(scene, options).film, 8) < 4.5);
  }
}

}  // namespace
}  // namespace fathom::runtime
