// B17 and the closed forms P1 to P10: the mean of an image is the known radiance, within three standard errors. The
// standard error is at most a thousandth of the radiance.
//
// Samples are independent, so the variances that the film accumulates add up. A first small image estimates the
// number of samples needed. Among fifty correct rows, one in eight tables would have a row beyond three standard
// errors. A row beyond them is therefore measured once more, with four times the samples and another seed, and only
// the second result counts.
#include <cmath>

#include "bench/light_bars/light_bars.h"
#include "runtime/render.h"
#include "tests/support/light_scenes.h"

namespace fathom::bench {
namespace {

using runtime::RenderOptions;
using test::LightScene;

constexpr int kSide = 32;        // pixels
constexpr double kRound = 2e-5;  // relative error from float and from the film's fixed point when nothing is random

struct Measured {
  double mean = 0, sigma = 0;  // sigma: standard error of the mean
  bool clean = true;           // true when no ray was invalid, no sample dropped and no sum saturated
};

Measured measure(const compiler::CompiledScene& scene, RenderOptions options) {
  options.width = options.height = kSide;
  options.sampler = compiler::SamplerKind::Independent;
  options.filter = compiler::FilterKind::Box;
  options.layers.variance = true;
  const runtime::RenderResult result = runtime::render(scene, options);
  Measured measured;
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const runtime::PixelMeans means = result.film.means(x, y);
      measured.mean += means.radiance.x / (kSide * kSide);
      measured.sigma += means.variance.x;
    }
  }
  measured.sigma = std::sqrt(measured.sigma) / (kSide * kSide);
  measured.clean = result.stats.march.invalid + result.stats.dropped_samples + result.stats.saturated == 0;
  return measured;
}

class Furnaces {
 public:
  Furnaces(BarTable& table, double relative_sigma) : table_(table), relative_sigma_(relative_sigma) {}

  void row(const std::string& bar, const std::string& what, const LightScene& known,
           RenderOptions options = {}) const {
    const compiler::CompiledScene scene = compile_scene(known.json);
    options.spp = 64;
    const Measured pilot = measure(scene, options);
    // 20 % more samples than needed (10 % in sigma), for the error of the pilot's own sigma.
    const double wanted = 64 * 1.2 * std::pow(pilot.sigma / (relative_sigma_ * known.radiance), 2);
    options.spp = static_cast<int>(std::clamp(std::ceil(wanted), 64.0, 65536.0));
    options.seed = 1;
    Measured measured = measure(scene, options);
    if (!right(measured, known)) {
      options.spp = std::min(4 * *options.spp, 262144);
      options.seed = 2;
      measured = measure(scene, options);
    }
    table_.row(bar, what, fmt::format("{:.5f} +- 3 sigma", known.radiance),
               fmt::format("{:.5f}, {:+.1f} sigma of {:.1e}", measured.mean,
                           (measured.mean - known.radiance) / std::max(measured.sigma, kRound * known.radiance),
                           measured.sigma / known.radiance),
               right(measured, known) && measured.sigma <= relative_sigma_ * known.radiance && measured.clean);
  }

 private:
  static bool right(const Measured& measured, const LightScene& known) {
    return std::abs(measured.mean - known.radiance) <= 3 * measured.sigma + kRound * known.radiance;
  }

  BarTable& table_;
  double relative_sigma_;
};

void closed_rooms(const Furnaces& furnaces) {
  for (const double albedo : {0.5, 0.8, 0.9}) {
    for (int bounces = 0; bounces <= 5; ++bounces) {
      RenderOptions options;
      options.rr_depth = bounces;
      furnaces.row("B17",
                   fmt::format("P1: closed ball that glows, albedo {}, roulette from bounce {}", albedo, bounces),
                   test::closed_room(albedo), options);
    }
  }
  furnaces.row("B17", "P1: closed box that glows, albedo 0.5",
               test::closed_room(0.5, R"("type": "box", "half_size": [1, 1, 1])"));
}

void even_light(const Furnaces& furnaces) {
  LightScene grey = test::in_even_light(R"({"type": "diffuse", "color": [0.6, 0.6, 0.6]})",
                                        R"("type": "box", "half_size": [3, 3, 0.5])");
  grey.radiance = 0.6;
  furnaces.row("B17", "P2: box of albedo 0.6 that fills the picture, in an even light", grey);
  const std::string white_metal = R"({"type": "principled", "metalness": 1, "color": [1, 1, 1], "roughness": )";
  const std::string glass = R"({"type": "principled", "transmission": 1, "color": [1, 1, 1], "roughness": )";
  const std::string white = R"({"type": "principled", "color": [1, 1, 1], "roughness": )";
  const std::pair<const char*, std::string> materials[] = {
      {"P2: white ball", R"({"type": "diffuse", "color": [1, 1, 1]})"},
      {"P2: mirror", R"({"type": "specular"})"},
      {"P7: glass", R"({"type": "transparent"})"},
      {"P7: glass of index 2.4", R"({"type": "transparent", "ior": 2.4})"},
      {"P7: principled glass, smooth", glass + "0}"},
      {"P7: principled glass, roughness 0.3", glass + "0.3}"},
      {"P7: principled glass, roughness 0.7", glass + "0.7}"},
      {"P2: white metal, smooth", white_metal + "0}"},
      {"P2: white metal, roughness 0.3", white_metal + "0.3}"},
      {"P2: white metal, roughness 0.7", white_metal + "0.7}"},
      {"P2: white metal, roughness 1", white_metal + "1}"},
      {"P2: white plastic, roughness 0.3", white + "0.3}"},
      {"P2: white plastic, roughness 1", white + "1}"},
  };
  for (const auto& [what, material] : materials) {
    furnaces.row("B17", fmt::format("{}, in an even light", what), test::in_even_light(material));
  }
}

void area_lights(const Furnaces& furnaces) {
  using runtime::LightSampling;
  const std::pair<const char*, LightScene> scenes[] = {
      {"P3: under a ball", test::under_ball(0.5, 0, 2)},
      {"P3: under a ball aside", test::under_ball(0.3, 1, 0.8)},
      {"P4: under a disc", test::under_disc(0.5, 1)},
      {"P5: under a rectangle", test::under_rectangle(0.4, 0.3, 0, 1)},
      {"P5: under a rectangle aside", test::under_rectangle(0.5, 0.2, 0.3, 0.6)},
  };
  for (const auto& [what, scene] : scenes) {
    for (const auto& [way, words] : {std::pair{LightSampling::Mis, "looking for it and hitting it"},
                                     {LightSampling::Nee, "looking for it"},
                                     {LightSampling::Bsdf, "hitting it"}}) {
      RenderOptions options;
      options.light_sampling = way;
      furnaces.row(std::string(what, 2), fmt::format("{}, {}", what, words), scene, options);
    }
  }
}

}  // namespace

void furnace_bars(BarTable& table, const LightCounts& counts) {
  const Furnaces furnaces(table, counts.relative_sigma);
  closed_rooms(furnaces);
  even_light(furnaces);
  area_lights(furnaces);
  for (const double albedo : {0.5, 0.9}) {
    for (const double degrees : {20.0, 40.0}) {
      RenderOptions options;
      // Starts Russian roulette early: few paths get out, so 40 bounces before it would cost far more.
      options.rr_depth = 2;
      furnaces.row("P6", fmt::format("P6: cavity of albedo {} with a hole of half angle {}", albedo, degrees),
                   test::cavity(albedo, degrees), options);
    }
  }
  furnaces.row("P8", "P8: through a slab of glass", test::slab());
  for (const double degrees : {0.0, 60.0, 120.0}) {
    furnaces.row("P10", fmt::format("P10: Lambert's ball at phase angle {}", degrees), test::moon(degrees));
  }
}

}  // namespace fathom::bench
