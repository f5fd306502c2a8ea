// Whole images against closed forms of their light, and the light sampling strategies against each other.
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "runtime/render.h"
#include "tests/runtime/estimate.h"
#include "tests/runtime/scenes.h"
#include "tests/support/catch.h"
#include "tests/support/light_scenes.h"
#include "tests/support/scaled_cases.h"
#include "tests/support/white_furnace.h"

namespace fathom::runtime::light_transport_test {
namespace {

using test::LightScene;

RenderOptions square(int side, int spp) {
  RenderOptions options;
  options.width = side;
  options.height = side;
  options.spp = spp;
  options.sampler = compiler::SamplerKind::Independent;  // so that the pixels' spread gives the error
  return options;
}

constexpr std::array kEveryWay = {LightSampling::Mis, LightSampling::Nee, LightSampling::Bsdf};

// Checks the mean within 4 standard errors, which are at most `error` of the value. With as many checks as this file
// has, one in a thousand correct renderers would fail.
void expect(const LightScene& scene, RenderOptions options, double error) {
  const RenderResult result = render(scene_of(scene.json), options);
  const Estimate found = estimate(result.film);
  INFO(scene.name << ": " << found.mean << " +- " << found.sigma << ", in closed form " << scene.radiance);
  CHECK(std::abs(found.mean - scene.radiance) <= 4 * found.sigma + 2e-5 * scene.radiance);
  CHECK(found.sigma <=
        error * std::sqrt(64.0 / test::scaled_cases(64)) * scene.radiance);  // fewer samples under sanitizers
  CHECK(result.stats.march.invalid + result.stats.dropped_samples == 0);
}

TEST_CASE("light: closed rooms, however paths end", "[light][render][released]") {
  for (const double albedo : {0.5, 0.8, 0.9}) {
    for (const int bounces : {0, 2, 5}) {
      RenderOptions options = square(24, test::scaled_cases(64));
      options.rr_depth = bounces;
      expect(test::closed_room(albedo), options, 2e-2);
    }
  }
  expect(test::closed_room(0.5, R"("type": "box", "half_size": [1, 1, 1])"), square(24, test::scaled_cases(64)),
         2e-2);
}

TEST_CASE("light: what absorbs nothing vanishes in an even light", "[light][render]") {
  for (const char* material : {R"({"type": "diffuse", "color": [1, 1, 1]})", R"({"type": "specular"})",
                               R"({"type": "transparent"})", R"({"type": "transparent", "ior": 2.4})",
                               // Regression: paths that entered through a hole and left by refraction brought 3.5 %
                               // too much.
                               R"({"type": "principled", "transmission": 1, "roughness": 0, "opacity": 0.5})"}) {
    for (const LightSampling way : kEveryWay) {
      RenderOptions options = square(16, test::scaled_cases(64));
      options.light_sampling = way;
      expect(test::in_even_light(material), options, 1e-2);
    }
  }
}

TEST_CASE("light: irradiance under lamps of every shape, in every way", "[light][render]") {
  const LightScene scenes[] = {test::under_ball(0.5, 0, 2), test::under_ball(0.3, 1, 0.8), test::under_disc(0.5, 1),
                               test::under_rectangle(0.4, 0.3, 0, 1), test::under_rectangle(0.5, 0.2, 0.3, 0.6)};
  for (const LightScene& scene : scenes) {
    for (const LightSampling way : kEveryWay) {
      INFO("way " << static_cast<int>(way));
      RenderOptions options = square(32, test::scaled_cases(way == LightSampling::Bsdf ? 256 : 64));
      options.light_sampling = way;
      expect(scene, options, way == LightSampling::Bsdf ? 2e-2 : 5e-3);
    }
  }
}

// Regression: any object in front of a light blocked shadow rays. A ball light was noisier, and a point light was
// lost.
TEST_CASE("light: holes and panes let light through to where it is looked for", "[light][render]") {
  for (const test::Veil& veil : {test::kGauze, test::kPane}) {
    INFO(veil.material);
    RenderOptions options = square(16, test::scaled_cases(64));
    options.max_depth = 1;  // no second bounce: the pane also reflects the floor's own light back to the floor
    expect(test::veiled_point(veil), options, 1e-3);
  }
  for (const LightSampling way : kEveryWay) {
    INFO("way " << static_cast<int>(way));
    RenderOptions options = square(32, test::scaled_cases(way == LightSampling::Bsdf ? 256 : 64));
    options.light_sampling = way;
    expect(test::veiled_ball(test::kGauze), options, way == LightSampling::Bsdf ? 3e-2 : 5e-3);
  }
}

// Regression: after each crossing, a shadow ray ended nearer to the area light than it should, and two walls hid the
// light.
TEST_CASE("light: many veils", "[light][render]") {
  for (const LightSampling way : {LightSampling::Mis, LightSampling::Nee}) {
    RenderOptions options = square(32, test::scaled_cases(64));
    options.light_sampling = way;
    expect(test::many_veils(), options, 2e-2);
  }
}

// Regression: a liquid between two veils absorbed nothing, because a shadow ray used only the absorption at its
// start.
TEST_CASE("light: a drink between veils takes its part", "[light][render]") {
  RenderOptions options = square(16, test::scaled_cases(64));
  options.max_depth = 1;
  expect(test::veiled_drink(), options, 1e-3);
}

// Regression: shadow rays found light on a clear area light's surface although water filled the area light, and light
// through an unbounded sea.
TEST_CASE("light: no more is found in water than gets there", "[light][render]") {
  for (const LightScene& scene : {test::submerged_area_light(), test::bottomless_sea()}) {
    for (const LightSampling way : kEveryWay) {
      INFO("way " << static_cast<int>(way));
      RenderOptions options = square(8, 16);
      options.light_sampling = way;
      expect(scene, options, 1e-3);
    }
  }
}

// Regression: a sheet of opacity 0.25 emitted as much as a sheet without holes: 5.8 instead of 1.875.
TEST_CASE("light: of a surface with holes only what is there emits", "[light][render]") {
  for (const double opacity : {0.25, 0.0}) {
    expect(test::glowing_gauze(opacity), square(16, test::scaled_cases(256)), 1e-2);
    for (const LightSampling way : kEveryWay) {
      INFO("opacity " << opacity << ", way " << static_cast<int>(way));
      RenderOptions options = square(32, test::scaled_cases(64));
      options.light_sampling = way;
      expect(test::under_glowing_gauze(opacity), options, 6e-2);
    }
  }
}

// Regression: a coat's colour tinted the reflected light, but not the emitted light.
TEST_CASE("light: a coat tints what is emitted below it", "[light][render]") {
  for (const LightSampling way : kEveryWay) {
    INFO("way " << static_cast<int>(way));
    RenderOptions options = square(32, test::scaled_cases(way == LightSampling::Bsdf ? 256 : 64));
    options.light_sampling = way;
    expect(test::under_coated_ball(), options, way == LightSampling::Bsdf ? 2e-2 : 5e-3);
  }
}

// Regression: Russian roulette ended paths caught in the glass regardless of their throughput. The few survivors
// weighed so much that most renders were 1 % too dark.
TEST_CASE("light: paths that lose nothing are not ended by chance", "[light][render][released]") {
  const auto scene =
      scene_of(test::furnace(R"({"type": "principled", "transmission": 1, "roughness": 0.15, "ior": 2.4})"));
  CHECK(test::returned(scene, 16, 256) == Approx(1).margin(4e-3));
}

TEST_CASE("light: random white materials return what they get", "[light][render]") {
  const int count = test::scaled_cases(16);
  double sum = 0;
  for (int i = 0; i < count; ++i) {
    const test::WhiteMaterial material = test::random_white(static_cast<std::uint32_t>(i));
    const double returned = test::returned(scene_of(test::furnace(material.json)), 16, 64);
    sum += returned;
    CAPTURE(material.json, returned);
    CHECK(returned < 1.04);
    CHECK(returned > (material.coat && material.glass ? 0.84 : 0.93));
    if (!material.glass && !material.rough_pigment) CHECK(returned == Approx(1).margin(1e-2));
  }
  CHECK(sum / count > 0.98);
}

// Straight transmission is not scattering: a path of any bounce limit sees the light behind a hole.
TEST_CASE("light: pass-through does not count as a bounce", "[light][render]") {
  LightScene scene =
      test::in_even_light(R"({"type": "principled", "color": [0, 0, 0], "specular_weight": 0, "opacity": 0.4})",
                          R"("type": "box", "half_size": [3, 3, 0.1])");
  scene.radiance = test::kGauze.passes;
  RenderOptions options = square(16, test::scaled_cases(256));
  options.max_depth = 0;
  expect(scene, options, 1e-1);
}

// Regression: a material without an interior had the refractive index of its surroundings and reflected nothing.
TEST_CASE("light: what is partly clear reflects, too", "[light][render]") {
  LightScene scene = test::smooth_gauze();
  RenderOptions options = square(16, test::scaled_cases(256));
  expect(scene, options, 1e-1);
}

TEST_CASE("light: a cavity gathers light by many bounces", "[light][render][released]") {
  for (const double albedo : {0.5, 0.9}) expect(test::cavity(albedo, 40), square(24, test::scaled_cases(128)), 3e-2);
}

TEST_CASE("light: a slab of glass passes 1 - R over 1 + R", "[light][render]") {
  expect(test::slab(), square(24, test::scaled_cases(64)), 1e-2);
}

TEST_CASE("light: Lambert's ball at every phase", "[light][render][released]") {
  for (const double degrees : {0.0, 60.0, 120.0}) {
    RenderOptions options = square(192, 4);
    const RenderResult result = render(scene_of(test::moon(degrees).json), options);
    const Estimate found = estimate(result.film);
    INFO(degrees << " degrees: " << found.mean << ", in closed form " << test::moon(degrees).radiance);
    CHECK(found.mean == Approx(test::moon(degrees).radiance).epsilon(3e-3));
  }
}

// An image divided into cells, rendered with several seeds: mean of each cell, and variance of that mean.
struct Cells {
  std::vector<double> mean, variance;
};

constexpr int kSide = 32, kCell = 4, kSeeds = 24;

Cells cells_of(const compiler::CompiledScene& scene, LightSampling way, int spp, std::uint64_t first_seed) {
  constexpr std::size_t kCells = (kSide / kCell) * (kSide / kCell);
  std::vector<double> sum(kCells), squares(kCells);
  RenderOptions options = square(kSide, spp);
  options.light_sampling = way;
  for (int seed = 0; seed < kSeeds; ++seed) {
    options.seed = first_seed + static_cast<std::uint64_t>(seed);
    const Film film = render(scene, options).film;
    std::vector<double> cells(kCells);
    for (int y = 0; y < kSide; ++y) {
      for (int x = 0; x < kSide; ++x) {
        cells[static_cast<std::size_t>(y / kCell * (kSide / kCell) + x / kCell)] += film.means(x, y).radiance.y;
      }
    }
    for (std::size_t i = 0; i < kCells; ++i) sum[i] += cells[i], squares[i] += cells[i] * cells[i];
  }
  Cells result;
  for (std::size_t i = 0; i < kCells; ++i) {
    const double mean = sum[i] / kSeeds;
    result.mean.push_back(mean);
    result.variance.push_back((squares[i] / kSeeds - mean * mean) / (kSeeds - 1));
  }
  return result;
}

TEST_CASE("light: looking for lights, hitting them and both give one picture", "[light][render][heavy]") {
  const auto scene = scene_of(test::kAreaLightRoom);
  const Cells both = cells_of(scene, LightSampling::Mis, 32, 0);
  for (const LightSampling way : {LightSampling::Nee, LightSampling::Bsdf}) {
    const Cells other = cells_of(scene, way, way == LightSampling::Bsdf ? 128 : 32, 1000);
    double worst = 0, all = 0;
    for (std::size_t i = 0; i < both.mean.size(); ++i) {
      const double t = (other.mean[i] - both.mean[i]) / std::sqrt(both.variance[i] + other.variance[i]);
      worst = std::max(worst, std::abs(t));
      all += t / std::sqrt(static_cast<double>(both.mean.size()));
    }
    // With 64 cells and some 46 degrees of freedom, one cell is beyond 4.2 in about 150 images. The sum over all
    // cells is beyond 3.3 once in a thousand.
    INFO("way " << static_cast<int>(way) << ": worst cell " << worst << ", all together " << all);
    CHECK(worst < 4.2);
    CHECK(std::abs(all) < 3.3);
  }
}

}  // namespace
}  // namespace fathom::runtime::light_transport_test
