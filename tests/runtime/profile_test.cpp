// The profile of a render: its numbers add up, and profiling changes no bit of the image.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include "runtime/render.h"
#include "tests/runtime/scenes.h"
#include "tests/support/catch.h"
#include "tests/support/program.h"
#include "tests/support/scaled_cases.h"
#include "vm/interpret/evaluate.h"

namespace fathom::runtime::profile_test {
namespace {

// A scene with grazing rays, which are decided in double, and with every way for a path to end.
const char* const kScene = R"("camera": {"position": [0, 1.2, 4], "target": [0, 0.5, 0]},
    "background": {"bottom": [0.1, 0.1, 0.1], "top": [0.5, 0.7, 1]},
    "materials": {"white": {"type": "diffuse"}, "glass": {"type": "transparent"},
                  "lamp": {"type": "emissive", "emission": [5, 5, 5]}},
    "objects": [{"type": "plane", "normal": [0, 1, 0], "material": "white"},
                {"type": "sphere", "radius": 0.5, "translate": [-0.6, 0.5, 0], "material": "glass"},
                {"type": "box", "half_size": [0.3, 0.001, 0.3], "translate": [0, 1.2, 0], "material": "lamp"}])";

RenderOptions options_of(int width, int height, int spp) {
  RenderOptions options;
  options.width = width;
  options.height = height;
  options.spp = spp;
  return options;
}

TEST_CASE("profile: the same picture and counts with and without", "[runtime][render]") {
  const auto scene = scene_of(kScene);
  RenderOptions options = options_of(70, 45, 4);
  options.threads = 1;
  const RenderResult plain = render(scene, options);
  CHECK_FALSE(plain.stats.stages);
  CHECK(plain.stats.march.certified > 0);
  options.profile = true;
  options.layers.cost = true;
  const RenderResult profiled = render(scene, options);
  CHECK(profiled.film.hash() == plain.film.hash());
  CHECK(profiled.stats.march.rays == plain.stats.march.rays);
  CHECK(profiled.stats.march.evaluations == plain.stats.march.evaluations);
  CHECK(profiled.stats.march.instructions == plain.stats.march.instructions);
  CHECK(profiled.stats.march.lanes == plain.stats.march.lanes);
}

TEST_CASE("profile: every stage takes time, and all of them a thread's", "[runtime][render]") {
  const auto scene = scene_of(kScene);
  for (const int threads : {1, 2}) {
    RenderOptions options = options_of(160, 90, test::scaled_cases(16));
    options.threads = threads;
    options.profile = true;
    // No stage includes the film's allocation and the start and end of threads. A busy machine can prolong these, but
    // not in every attempt.
    bool most = false;
    for (int attempt = 0; attempt < 20 && !most; ++attempt) {
      const Stats stats = render(scene, options).stats;
      REQUIRE(stats.stages);
      for (std::size_t i = 0; i < stats.stages->size(); ++i) {
        INFO(kStages[i]);
        CHECK((*stats.stages)[i] > 0);
      }
      const double sum = std::accumulate(stats.stages->begin(), stats.stages->end(), 0.0);
      INFO(threads << " threads, " << stats.seconds << " s, of which in stages " << sum);
      CHECK(sum <= threads * stats.seconds);
      most = sum >= 0.5 * stats.seconds;
    }
    CHECK(most);
  }
}

TEST_CASE("profile: instructions are those of the program, and registers are filled with rays", "[runtime][render]") {
  const auto scene = scene_of(kScene);
  for (const Marching marching : {Marching{}, Marching{.method = Method::Sphere, .precision = Precision::Double},
                                  Marching{.method = Method::Certified}}) {
    RenderOptions options = options_of(96, 54, 4);
    options.marching = marching;
    const Stats stats = render(scene, options).stats;
    INFO(info(marching.method).name);
    CHECK(stats.march.instructions == stats.march.evaluations * scene.distance.instructions());
    CHECK(stats.instructions_per_evaluation() == scene.distance.instructions());
    CHECK(stats.utilisation() <= 1);
    CHECK(stats.utilisation() > 0.9);
  }
}

TEST_CASE("profile: a wider register has more lanes to spare", "[runtime][render]") {
  const auto scene = scene_of(kScene);
  RenderOptions options = options_of(64, 36, 4);
  options.threads = 1;
  const std::string in_use(vm::isa_name());
  std::uint64_t last = ~std::uint64_t{0}, evaluations = 0;
  for (const std::string_view isa : vm::available_isas()) {  // best first
    REQUIRE(vm::force_isa(isa));
    const MarchCounters counters = render(scene, options).stats.march;
    INFO(isa);
    // The sanitized build supports fewer widths than instruction sets (CMakeLists.txt).
    CHECK((counters.lanes < last || (test::is_sanitized() && counters.lanes == last)));
    CHECK(counters.lanes >= counters.evaluations - counters.certified_evaluations);
    if (evaluations > 0) CHECK(counters.evaluations == evaluations);
    last = counters.lanes;
    evaluations = counters.evaluations;
  }
  REQUIRE(vm::force_isa(in_use));
}

TEST_CASE("profile: the cost of all pixels is what was counted, for any threads and tiles", "[runtime][render]") {
  const auto scene = scene_of(kScene);
  std::vector<double> reference;
  for (const int threads : {1, 2, 3}) {
    for (const int tile : {7, 16}) {
      RenderOptions options = options_of(70, 45, 3);
      options.threads = threads;
      options.tile = tile;
      options.layers = {.first_hit = false, .cost = true};
      const RenderResult result = render(scene, options);
      std::vector<double> cost;
      double evaluations = 0, instructions = 0;
      for (int y = 0; y < 45; ++y) {
        for (int x = 0; x < 70; ++x) {
          const PixelMeans pixel = result.film.means(x, y);
          cost.push_back(pixel.evaluations);
          evaluations += pixel.evaluations * pixel.samples;
          instructions += pixel.instructions * pixel.samples;
        }
      }
      INFO(threads << " threads, tiles of " << tile);
      CHECK(std::round(evaluations) == static_cast<double>(result.stats.march.evaluations));
      CHECK(std::round(instructions) == static_cast<double>(result.stats.march.instructions));
      if (reference.empty()) reference = cost;
      CHECK(cost == reference);
    }
  }
  CHECK(*std::max_element(reference.begin(), reference.end()) >
        2 * *std::min_element(reference.begin(), reference.end()));
}

}  // namespace
}  // namespace fathom::runtime::profile_test
