// Whole images against closed forms, and independence of threads and tiles.
#include "runtime/render.h"

#include <array>
#include <atomic>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <memory>
#include <vector>

#include "runtime/base/color.h"
#include "runtime/base/tiles.h"
#include "runtime/film/film_channels.h"
#include "tests/runtime/estimate.h"
#include "tests/runtime/scenes.h"
#include "tests/support/catch.h"

namespace fathom::runtime::render_test {
namespace {

RenderOptions options_of(int width, int height, int spp) {
  RenderOptions options;
  options.width = width;
  options.height = height;
  options.spp = spp;
  options.sampler = compiler::SamplerKind::Independent;  // so that the pixels' spread gives the error
  return options;
}

void expect_mean(const RenderResult& result, double reference) {
  const Estimate found = estimate(result.film);
  INFO("mean " << found.mean << " +- " << found.sigma);
  CHECK(std::abs(found.mean - reference) <= 3 * found.sigma + 1e-6 * reference);
  CHECK(found.sigma <= 2e-3 * reference);
  CHECK(result.stats.march.invalid == 0);
  CHECK(result.stats.march.exhausted == 0);
  CHECK(result.stats.dropped_samples == 0);
}

std::string furnace(double albedo) {
  const std::string a = std::to_string(albedo);
  return R"("camera": {"position": [0.3, 0.1, 0.2], "target": [0, 0, -1], "fov": 90},
      "materials": {"lamp": {"type": "emissive", "emission": [1, 1, 1], "color": [)" +
         a + "," + a + "," + a + R"(]}},
      "objects": [{"type": "sphere", "radius": 1, "material": "lamp"}])";
}

TEST_CASE("render: white furnace, 1/(1 - albedo)", "[runtime][heavy][render]") {
  expect_mean(render(scene_of(furnace(0.5)), options_of(64, 64, 64)), 2);
  expect_mean(render(scene_of(furnace(0.8)), options_of(64, 64, 128)), 5);
}

TEST_CASE("render: Russian roulette keeps the mean wherever it begins", "[runtime][heavy][render]") {
  const auto scene = scene_of(furnace(0.8));
  for (const int bounces : {0, 1, 3, 30}) {
    RenderOptions options = options_of(48, 48, 64);
    options.rr_depth = bounces;
    INFO("bounces " << bounces);
    const RenderResult result = render(scene, options);
    const Estimate found = estimate(result.film);
    CHECK(std::abs(found.mean - 5) <= 4 * found.sigma + 1e-5);
  }
}

TEST_CASE("render: paths that are cut off bring what they met until then", "[runtime][render]") {
  RenderOptions options = options_of(16, 16, 4);
  options.max_depth = 2;
  const Estimate found = estimate(render(scene_of(furnace(0.8)), options).film);
  CHECK(found.mean == Approx(1 + 0.8 + 0.64).epsilon(1e-6));
  CHECK(found.sigma < 1e-6);
}

TEST_CASE("render: a ball lamp over a floor, E = pi L (R/d)^2", "[runtime][render][heavy]") {
  // The floor's radiance under the lamp is albedo E / pi. The orthographic camera looks from the side at a small spot
  // below the lamp and sees nothing else. The spot is so small that E varies by 1e-4.
  const auto scene = scene_of(R"("camera": {"type": "orthographic", "position": [3, 1, 0], "target": [0, 0, 0],
        "width": 0.01},
      "materials": {"floor": {"type": "diffuse", "color": [0.5, 0.5, 0.5]},
                    "lamp": {"type": "emissive", "emission": [8, 8, 8]}},
      "objects": [{"type": "plane", "normal": [0, 1, 0], "material": "floor"},
                  {"type": "sphere", "radius": 0.5, "translate": [0, 2, 0], "material": "lamp"}])");
  const RenderResult result = render(scene, options_of(64, 64, 512));
  const double radiance = 0.5 * 8 * (0.5 / 2) * (0.5 / 2);
  const Estimate found = estimate(result.film);
  INFO("mean " << found.mean << " +- " << found.sigma);
  CHECK(std::abs(found.mean - radiance) <= 3 * found.sigma + 1e-4 * radiance);
  CHECK(found.sigma <= 5e-3 * radiance);
}

TEST_CASE("render: glass and mirrors vanish in an even light", "[runtime][render]") {
  for (const char* material : {R"({"type": "transparent", "ior": 1.5})", R"({"type": "specular"})",
                               R"({"type": "diffuse", "color": [1, 1, 1]})"}) {
    const auto scene = scene_of(std::string(R"("camera": {"position": [0, 0, 3], "fov": 60}, "background": [1, 1, 1],
        "materials": {"m": )") + material +
                                R"(}, "objects": [{"type": "sphere", "radius": 1, "material": "m"}])");
    RenderOptions options = options_of(32, 32, 64);
    options.rr_depth = 60;
    const RenderResult result = render(scene, options);
    const Estimate found = estimate(result.film);
    INFO(material << " mean " << found.mean << " +- " << found.sigma);
    CHECK(std::abs(found.mean - 1) <= 1e-3);
    CHECK(result.stats.march.invalid == 0);
  }
}

TEST_CASE("render: glass absorbs along the way through it", "[runtime][render]") {
  // A slab without refraction, perpendicular to the view: exp(-absorption * thickness).
  const auto scene = scene_of(R"("camera": {"type": "orthographic", "position": [0, 0, 3], "width": 0.5},
      "background": [1, 1, 1],
      "materials": {"m": {"type": "transparent", "ior": 1, "absorption": [1, 2, 0]}},
      "objects": [{"type": "box", "half_size": [1, 1, 0.25], "material": "m"}])");
  const glm::dvec3 radiance = render(scene, options_of(4, 4, 1)).film.means(1, 1).radiance;
  CHECK(radiance.x == Approx(std::exp(-0.5)).epsilon(1e-4));
  CHECK(radiance.y == Approx(std::exp(-1.0)).epsilon(1e-4));
  CHECK(radiance.z == Approx(1).epsilon(1e-4));
}

TEST_CASE("render: the background is linear in the sine of the elevation, and up is up", "[runtime][render]") {
  const auto scene = scene_of(R"("camera": {"position": [0, 0, 3], "fov": 90},
      "background": {"bottom": [0, 0, 0], "top": [1, 1, 1]},
      "objects": [{"type": "sphere", "radius": 0.1, "translate": [0, 0, 100]}])");
  const RenderResult result = render(scene, options_of(3, 3, 1));
  // Sine of the elevation at the centre of the middle column's top pixel.
  const double sine = (2.0 / 3) / std::sqrt(1 + 4.0 / 9);
  CHECK(result.film.means(1, 0).radiance.x == Approx((1 + sine) / 2).epsilon(1e-6));
  CHECK(result.film.means(1, 1).radiance.x == Approx(0.5).epsilon(1e-6));
  CHECK(result.film.means(1, 2).radiance.x == Approx((1 - sine) / 2).epsilon(1e-6));
  CHECK(result.stats.primary_hits == 0);
}

TEST_CASE("render: what lies first along the camera's rays", "[runtime][render]") {
  const auto scene = scene_of(R"("camera": {"type": "orthographic", "position": [0, 0, 3], "width": 4},
      "materials": {"m": {"type": "diffuse", "color": [0.2, 0.4, 0.6]}},
      "objects": [{"type": "box", "half_size": [1, 1, 0.5], "material": "m"}])");
  const RenderResult result = render(scene, options_of(4, 4, 1));
  const PixelMeans hit = result.film.means(1, 1), missed = result.film.means(0, 0);
  CHECK(hit.depth == Approx(2.5).epsilon(1e-6));
  CHECK(hit.albedo.y == Approx(0.4).epsilon(1e-6));
  CHECK(hit.normal.z == Approx(1).epsilon(1e-6));
  CHECK(missed.hits == 0);
  CHECK(result.stats.primary_rays == 16);
  CHECK(result.stats.primary_hits == 4);
}

const char* const kVaried = R"("camera": {"position": [0, 1.2, 4], "target": [0, 0.5, 0]},
    "background": {"bottom": [0.1, 0.1, 0.1], "top": [0.5, 0.7, 1]},
    "materials": {"white": {"type": "diffuse"}, "glass": {"type": "transparent", "absorption": [0.3, 0.1, 0]},
                  "mirror": {"type": "specular", "color": [0.9, 0.9, 0.8]},
                  "lamp": {"type": "emissive", "emission": [5, 5, 5]}},
    "objects": [{"type": "plane", "normal": [0, 1, 0], "material": "white"},
                {"type": "sphere", "radius": 0.5, "translate": [-0.6, 0.5, 0], "material": "glass"},
                {"type": "torus", "major_radius": 0.4, "minor_radius": 0.15, "translate": [0.6, 0.4, 0],
                 "material": "mirror"},
                {"type": "box", "half_size": [0.3, 0.05, 0.3], "translate": [0, 2, 0], "material": "lamp"}])";

TEST_CASE("render: threads and tiles leave no trace in the picture", "[runtime][render][threads]") {
  const auto scene = scene_of(kVaried);
  RenderOptions options = options_of(70, 45, 4);
  options.threads = 1;
  const RenderResult reference = render(scene, options);
  for (const int threads : {1, 2, 3}) {
    for (const int tile : {8, 16, 17}) {
      options.threads = threads;
      options.tile = tile;
      const RenderResult result = render(scene, options);
      INFO(threads << " threads, tiles of " << tile);
      CHECK(result.film.hash() == reference.film.hash());
      CHECK(result.stats.march.rays == reference.stats.march.rays);
      CHECK(result.stats.march.evaluations == reference.stats.march.evaluations);
    }
  }
  options.seed = 1;
  CHECK(render(scene, options).film.hash() != reference.film.hash());
}

TEST_CASE("render: rays are the camera's, towards lights, or after a bounce", "[runtime][render]") {
  const auto scene = scene_of(kVaried);
  RenderOptions options = options_of(20, 12, 4);
  const Stats both = render(scene, options).stats;
  CHECK(both.primary_rays == 20 * 12 * 4);
  CHECK(both.primary_rays + both.shadow_rays + both.bounce_rays == both.march.rays);
  CHECK(both.shadow_rays > 0);
  options.light_sampling = LightSampling::Bsdf;
  const Stats hits = render(scene, options).stats;
  CHECK(hits.shadow_rays == 0);
  CHECK(hits.bounce_rays == both.bounce_rays);  // the same paths in both
  options.max_depth = 0;
  CHECK(render(scene, options).stats.bounce_rays == 0);
}

TEST_CASE("render: clamping takes light from long paths only, and never adds any", "[runtime][render]") {
  const auto scene = scene_of(kVaried);
  const auto film_of = [&](std::optional<int> max_depth, std::optional<double> clamp) {
    RenderOptions options = options_of(20, 12, 16);
    options.max_depth = max_depth;
    options.clamp = clamp;
    return render(scene, options).film;
  };
  CHECK(film_of(1, 0.01).hash() == film_of(1, std::nullopt).hash());
  CHECK(film_of(std::nullopt, 1e9).hash() == film_of(std::nullopt, std::nullopt).hash());
  const Film whole = film_of(std::nullopt, std::nullopt), clamped = film_of(std::nullopt, 0.05);
  const Film two = film_of(1, std::nullopt);
  double lost = 0;
  for (int y = 0; y < 12; ++y) {
    for (int x = 0; x < 20; ++x) {
      const double all = whole.means(x, y).radiance.y, rest = clamped.means(x, y).radiance.y;
      CHECK(rest <= all + 1e-6);
      lost += all - rest;
    }
  }
  CHECK(lost > 0.1);
  CHECK(estimate(clamped).mean > estimate(two).mean);
}

TEST_CASE("render: a sample clamp limits every sample, and leaves the samples below it", "[runtime][render]") {
  const auto scene = scene_of(kVaried);
  for (const compiler::FilterKind filter : {compiler::FilterKind::Box, compiler::FilterKind::Mitchell}) {
    RenderOptions options = options_of(20, 12, 2);
    options.sample_range = SampleRange{0, 1};
    options.filter = filter;
    const Film whole = render(scene, options).film;
    options.sample_clamp = 1e9;
    CHECK(render(scene, options).film.hash() == whole.hash());
    options.sample_clamp = 0.7;
    const Film clamped = render(scene, options).film;
    int limited = 0;
    for (int y = 0; y < 12; ++y) {
      for (int x = 0; x < 20; ++x) {
        const glm::vec3 before = whole.means(x, y).radiance, after = clamped.means(x, y).radiance;
        const float brightest = max_component(glm::abs(before));
        const bool over = brightest > 0.7f;
        limited += over;
        CHECK(glm::distance(after, over ? before * (0.7f / brightest) : before) < 1e-6f);
      }
    }
    CHECK((limited > 0 && limited < 240));
  }
}

TEST_CASE("render: tiles take every pixel once, and a small picture has enough of them for all threads",
          "[runtime][render]") {
  CHECK(tile_side(640, 360, 16, 2) == 16);
  CHECK(tile_side(64, 36, 16, 2) < 16);
  CHECK(tile_side(3, 2, 1024, 32) == 1);
  for (const auto& [width, height, threads] : {std::array{70, 45, 2}, {5, 300, 3}, {1, 1, 8}, {33, 17, 16}}) {
    const int side = tile_side(width, height, 16, threads);
    INFO(width << " x " << height << ", " << threads << " threads: tiles of " << side);
    const Tiles tiles({0, 0, width, height}, side);
    std::vector<int> taken(static_cast<std::size_t>(width * height));
    for (std::int64_t i = 0; i < tiles.count(); ++i) {
      const PixelRect tile = tiles.at(i);
      for (int y = tile.y0; y < tile.y1; ++y) {
        for (int x = tile.x0; x < tile.x1; ++x) ++taken[static_cast<std::size_t>(y * width + x)];
      }
    }
    CHECK(taken == std::vector<int>(taken.size(), 1));
    CHECK(tiles.count() >= std::min(width * height, kTilesPerThread * threads));
  }
}

TEST_CASE("render: a crop has the bits of the picture there, in every layer", "[runtime][render]") {
  const auto scene = scene_of(kVaried);
  RenderOptions options = options_of(48, 27, 3);
  options.layers = kAllLayers;
  const RenderResult whole = render(scene, options);
  for (const PixelRect crop : {PixelRect{5, 3, 30, 20}, {47, 26, 48, 27}, {0, 0, 48, 1}}) {
    options.crop = crop;
    options.threads = crop.x0 == 5 ? 3 : 1;
    const RenderResult part = render(scene, options);
    CHECK(part.film.area() == crop);
    CHECK(part.stats.primary_rays == crop.pixels() * 3);
    int different = 0;
    for (int y = crop.y0; y < crop.y1; ++y) {
      for (int x = crop.x0; x < crop.x1; ++x) {
        const PixelMeans a = whole.film.means(x, y), b = part.film.means(x, y);
        for (const FilmChannel& channel : film_channels()) different += channel.value(a) != channel.value(b);
      }
    }
    CHECK(different == 0);
  }
}

TEST_CASE("render: ranges of samples add up to the whole, and what was stopped goes on",
          "[runtime][render][threads]") {
  const auto scene = scene_of(kVaried);
  RenderOptions options = options_of(40, 24, 24);
  options.layers = kAllLayers;
  options.layers.halves = true;
  for (const compiler::SamplerKind sampler : {compiler::SamplerKind::Blue, compiler::SamplerKind::Independent}) {
    options.sampler = sampler;
    const RenderResult whole = render(scene, options);
    CHECK(whole.covered[0].blocks() == std::vector<SampleBlock>{{{0, 0, 40, 24}, {0, 24}}});
    Film sum({0, 0, 40, 24}, options.layers);
    for (const SampleRange range : {SampleRange{17, 24}, {0, 5}, {5, 17}}) {
      RenderOptions some = options;
      some.sample_range = range;
      sum.merge(render(scene, some).film);
    }
    CHECK(sum.hash() == whole.film.hash());
    for (int stop = 1; stop < 40; stop += 6) {
      RenderOptions stopping = options;
      std::atomic<bool> cancel = false;
      stopping.cancel = &cancel;
      stopping.tile = 5;
      int units = 0;
      stopping.on_progress = [&](const Progress&) { cancel = ++units >= stop; };
      const RenderResult stopped = render(scene, stopping);
      REQUIRE(stopped.stats.end == RenderEnd::Cancelled);
      REQUIRE(stopped.film.samples() == stopped.covered[0].size());
      RenderOptions going_on = options;
      going_on.resume_from = std::make_shared<PartialRender>(stopped);
      going_on.threads = 1 + stop % 3;
      const RenderResult resumed = render(scene, going_on);
      CHECK(resumed.film.hash() == whole.film.hash());
      CHECK(resumed.covered == whole.covered);
      CHECK(resumed.stats.resumed_samples == stopped.film.samples());
      CHECK(going_on.resume_from->film.area().pixels() == 0);  // the film is moved, not copied
      CHECK(resumed.stats.primary_rays == 40u * 24u * 24u - stopped.film.samples());
    }
  }
}

TEST_CASE("render: a position lies on the surface that its ids name", "[runtime][render]") {
  const auto scene = scene_of(R"("camera": {"position": [0, 0, 5]},
      "materials": {"a": {"type": "diffuse"}, "b": {"type": "diffuse", "color": [0, 0, 1]}},
      "objects": [{"name": "ball", "type": "sphere", "radius": 1, "material": "a"},
                  {"name": "wall", "type": "plane", "normal": [0, 0, 1], "offset": -1, "material": "b"}])");
  RenderOptions options = options_of(32, 32, 1);
  options.layers = kAllLayers;
  const RenderResult result = render(scene, options);
  int balls = 0;
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 32; ++x) {
      const PixelMeans pixel = result.film.means(x, y);
      REQUIRE(pixel.surface_id > 0);
      const bool ball = scene.surfaces[pixel.surface_id - 1].name == "ball";
      balls += ball;
      CHECK(pixel.material_id - 1 == scene.surfaces[pixel.surface_id - 1].material);
      const glm::dvec3 p = pixel.position;
      CHECK(std::abs(ball ? glm::length(p) - 1 : p.z + 1) < 1e-5);
      CHECK(glm::length(p - glm::dvec3(0, 0, 5)) == Approx(pixel.depth).epsilon(1e-6));
    }
  }
  CHECK(balls > 50);
  CHECK(balls < 900);
}

TEST_CASE("render: no ray is lost in a scene of everything", "[runtime][render]") {
  const RenderResult result = render(scene_of(kVaried), options_of(160, 90, 8));
  CHECK(result.stats.march.invalid == 0);
  CHECK(result.stats.march.exhausted == 0);
  CHECK(result.stats.dropped_samples == 0);
  CHECK(result.stats.primary_rays == 160u * 90u * 8u);
}

TEST_CASE("render: progress ends at one, and a cancelled render returns", "[runtime][render][threads]") {
  const auto scene = scene_of(kVaried);
  RenderOptions options = options_of(64, 64, 1);
  double last = 0;
  options.on_progress = [&](const Progress& progress) {
    CHECK(progress.fraction > last);
    last = progress.fraction;
  };
  CHECK(render(scene, options).stats.end == RenderEnd::Done);
  CHECK(last == 1);

  const std::atomic<bool> cancel = true;
  options.cancel = &cancel;
  const RenderResult nothing = render(scene, options);
  CHECK(nothing.stats.end == RenderEnd::Cancelled);
  CHECK(nothing.stats.primary_rays == 0);
}

TEST_CASE("render: options overrule the scene, which overrules the defaults", "[runtime][render]") {
  const auto scene = scene_of(R"("film": {"width": 30, "height": 20}, "render": {"spp": 7, "rr_depth": 3},
      "objects": [{"type": "sphere", "radius": 1}])");
  RenderOptions options;
  options.spp = 2;
  options.threads = 3;
  const Settings settings = resolve(scene, options);
  CHECK(settings.width == 30);
  CHECK(settings.spp == 2);
  CHECK(settings.rr_depth == 3);
  CHECK(settings.tile == 16);
  CHECK(settings.threads == 3);
}

}  // namespace
// Regression: rays leaving the top of a huge box hit the box again. Float resolves its surface only to 5e-4
// (coordinates of 10^4 cancel), and the rays started closer than this. A plane is the same floor without the large
// coordinates.
TEST_CASE("render: a floor that is the top of a huge solid is as bright as a plane", "[runtime][render][heavy]") {
  const auto with_floor = [](const std::string& floor) {
    return scene_of(R"("background": [1, 1, 1], "camera": {"position": [0, 1.5, 4], "target": [0, 0.5, 0]},
        "objects": [)" +
                    floor + R"(, {"type": "sphere", "radius": 0.5, "translate": [0, 0.5, 0]}])");
  };
  const RenderOptions options = options_of(64, 36, 64);
  const Estimate plane = estimate(render(with_floor(R"({"type": "plane", "normal": [0, 1, 0]})"), options).film);
  const RenderResult result =
      render(with_floor(R"({"type": "box", "half_size": [1e4, 1e4, 1e4], "translate": [0, -1e4, 0]})"), options);
  const Estimate box = estimate(result.film);
  INFO("plane " << plane.mean << ", box " << box.mean << " +- " << box.sigma);
  CHECK(std::abs(box.mean - plane.mean) < 3 * (box.sigma + plane.sigma));
}

// Regression: a ball 1e5 from the origin was rendered in three pieces and without a shadow, because float steps near
// the surface were longer than the ball. The programs now have their origin near the scene, and equal those of the
// scene at zero.
TEST_CASE("render: a scene far from the origin looks as it does there", "[runtime][render][heavy]") {
  const auto at = [](double x) {
    const std::string x0 = std::to_string(x), x1 = std::to_string(x + 1.5);
    return scene_of(R"("background": [1, 1, 1], "camera": {"position": [)" + x0 + R"(, 1, 5], "target": [)" + x0 +
                    R"(, 0.5, 0]}, "objects": [{"type": "plane", "normal": [0, 1, 0]},
                    {"type": "sphere", "radius": 0.5, "translate": [)" +
                    x0 + R"(, 0.5, 0]}, {"type": "box", "half_size": [0.5, 0.25, 0.5], "rotate": [0, 30, 0],
                     "translate": [)" +
                    x1 + ", 0.25, 0]}]");
  };
  const RenderOptions options = options_of(64, 36, 64);
  const RenderResult here = render(at(0), options);
  for (const double x : {1e3, 1e4, 1e5, 1e6, -1e6}) {
    const RenderResult there = render(at(x), options);
    INFO("x " << x << ": " << there.stats.march.certified << " rays decided in double, not "
              << here.stats.march.certified);
    CHECK(there.film.hash() == here.film.hash());
    CHECK(there.stats.march.certified == here.stats.march.certified);
    CHECK(there.stats.march.exhausted + there.stats.march.invalid == 0);
  }
  // With less round coordinates, pixels differ because the scene's own coordinates are rounded.
  const Estimate expected = estimate(here.film);
  const RenderResult there = render(at(123456.789), options);
  const Estimate found = estimate(there.film);
  CHECK(std::abs(found.mean - expected.mean) <= 1e-3 * expected.mean);
  int different = 0;
  for (int y = 0; y < 36; ++y) {
    for (int i = 0; i < 64; ++i) {
      different += glm::length(here.film.means(i, y).normal - there.film.means(i, y).normal) > 0.01;
    }
  }
  CHECK(different <= 2);
  CHECK(there.stats.march.certified <= here.stats.march.certified + there.stats.march.rays / 500);
}

// Regression: a plane cut off every scene at ten thousand units from the camera.
TEST_CASE("render: a large scene with a plane is not cut off", "[runtime][render]") {
  const auto scene =
      scene_of(R"("background": [1, 1, 1], "camera": {"position": [0, 15000, 40000], "target": [0, 5000, 0]},
      "objects": [{"type": "plane", "normal": [0, 1, 0]}, {"type": "sphere", "radius": 5000, "translate": [0, 5000, 0]}])");
  const RenderResult result = render(scene, options_of(64, 36, 1));
  CHECK(result.stats.primary_hits == result.stats.primary_rays);
}

}  // namespace fathom::runtime::render_test
