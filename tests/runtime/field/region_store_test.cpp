// Regions kept from one render to the next.
#include "runtime/field/region_store.h"

#include <string>

#include "runtime/field/field.h"
#include "runtime/render.h"
#include "tests/support/catch.h"
#include "tests/support/compiled.h"

namespace fathom::region_store_test {
namespace {

using namespace fathom;
using runtime::RegionOptions;
using runtime::RegionStore;

// A cube of balls, large enough for regions. `first` moves the first ball.
compiler::CompiledScene balls(double first, double light = 1) {
  std::string objects;
  for (int i = 0; i < 729; ++i) {
    const double x = i % 9 + (i == 0 ? first : 0);
    objects += std::string(i > 0 ? "," : "") + R"({"type": "sphere", "radius": 0.3, "translate": [)" +
               std::to_string(x) + "," + std::to_string(i / 9 % 9) + "," + std::to_string(i / 81) + "]}";
  }
  return test::compiled(
      R"({"version": 1, "camera": {"position": [3, 3, 20], "target": [3, 3, 3]}, "film": {"width": 32, "height": 24},
    "render": {"spp": 16}, "background": [)" +
      std::to_string(light) + R"(, 1, 1], "objects": [)" + objects + "]}");
}

RegionOptions options() {
  RegionOptions options;
  options.always = true;
  return options;
}

TEST_CASE("region store: the same program, box and options have the same regions; others their own", "[field]") {
  const compiler::CompiledScene a = balls(0), same = balls(0), moved = balls(0.1);
  RegionStore store;
  const auto first = store.build(a.surface, a.contents, options());
  REQUIRE(first);
  CHECK_FALSE(store.reused(*first));
  RegionOptions threads = options();
  threads.threads = 2;
  CHECK(store.build(same.surface, same.contents, threads) == first);
  CHECK(store.reused(*first));
  CHECK(store.build(moved.surface, moved.contents, options()) != first);
  RegionOptions less = options();
  less.memory /= 2;
  CHECK(store.build(a.surface, a.contents, less) != first);
  RegionOptions larger = options();
  larger.room = 1;
  CHECK(store.build(a.surface, a.contents, larger) != first);
}

TEST_CASE("region store: what was not asked for is forgotten, and lives on with who has it", "[field]") {
  std::shared_ptr<const runtime::Regions> first;
  RegionStore store;
  {
    const compiler::CompiledScene a = balls(0), b = balls(0.1);
    first = store.build(a.surface, a.contents, options());
    store.drop_unused();
    CHECK(store.build(a.surface, a.contents, options()) == first);
    store.drop_unused();
    store.build(b.surface, b.contents, options());
    store.drop_unused();
    const auto again = store.build(a.surface, a.contents, options());
    CHECK(again != first);
    CHECK_FALSE(store.reused(*again));
  }
  // The scene's program no longer exists here: the regions use their own copy.
  runtime::RealScratch scratch;
  std::uint64_t instructions = 0;
  CHECK(first->evaluate(glm::dvec3(0, 0, 0.3), scratch, instructions) == Approx(0).margin(1e-9));
}

TEST_CASE("region store: those that were interrupted are not kept, those that cannot be are", "[field]") {
  const compiler::CompiledScene a = balls(0);
  RegionStore store;
  RegionOptions interrupted = options();
  interrupted.interrupted = [] { return true; };
  CHECK_FALSE(store.build(a.surface, a.contents, interrupted));
  CHECK(store.build(a.surface, a.contents, options()));
  RegionOptions tiny = options();
  tiny.memory = 1;
  CHECK_FALSE(store.build(a.surface, a.contents, tiny));
  CHECK_FALSE(store.build(a.surface, a.contents, tiny));
}

TEST_CASE("region store: a render with kept regions has the bits of one without, and says that they are kept",
          "[field]") {
  const compiler::CompiledScene first = balls(0), other_light = balls(0, 0.5);
  runtime::RenderOptions options;
  const std::uint64_t wanted = runtime::render(other_light, options).film.hash();
  options.region_store = std::make_shared<RegionStore>();
  const runtime::RenderResult built = runtime::render(first, options);
  REQUIRE(built.stats.region_bytes > 0);
  CHECK(built.stats.regions_reused == 0);
  const runtime::RenderResult reused = runtime::render(other_light, options);
  CHECK(reused.stats.regions_reused == 1);
  CHECK(reused.stats.region_seconds == 0);
  CHECK(reused.stats.region_bytes == built.stats.region_bytes);
  CHECK(reused.film.hash() == wanted);
}

}  // namespace
}  // namespace fathom::region_store_test
