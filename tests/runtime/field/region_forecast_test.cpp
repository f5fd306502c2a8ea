// Decisions for and against regions: they are built where they pay, and a scene without them loses no more than the
// forecast.
#include "runtime/field/region_forecast.h"

#include <algorithm>
#include <string>

#include "runtime/field/field.h"
#include "tests/support/catch.h"
#include "tests/support/compiled.h"
#include "tests/support/random/random_scene.h"

namespace fathom::region_forecast_test {
namespace {

using namespace fathom;

// Balls of a size at random places in a cube.
compiler::CompiledScene balls(int count, double radius, const std::string& join) {
  test::Random random(count);
  std::string of;
  for (int i = 0; i < count; ++i) {
    const glm::dvec3 p = random.in_box(1);
    of += std::string(i > 0 ? "," : "") + R"({"type": "sphere", "radius": )" + std::to_string(radius) +
          R"(, "translate": [)" + std::to_string(p.x) + "," + std::to_string(p.y) + "," + std::to_string(p.z) + "]}";
  }
  return test::compiled(R"({"version": 1, "objects": [{"type": )" + join + R"(, "of": [)" + of + "]}]}");
}

// True if the scene has regions when they may be evaluated so many times.
bool builds(const compiler::CompiledScene& scene, double evaluations) {
  runtime::Field field = runtime::make_field(scene);
  add_regions(field, scene, {.evaluations = evaluations});
  return field.regions != nullptr;
}

const std::string kUnion = R"("union")";

TEST_CASE("region forecast: scattered bodies have regions in all pictures except the smallest", "[field][regions]") {
  const compiler::CompiledScene scene = balls(2000, 0.02, kUnion);
  CHECK_FALSE(builds(scene, 1e4));
  CHECK(builds(scene, 2e6));
  CHECK(builds(scene, 1e8));
}

// Regression: building gave up after as much time as the picture took, because each cell holds hundreds of the balls.
TEST_CASE("region forecast: bodies that overlap everywhere have regions in large pictures", "[field][regions]") {
  const compiler::CompiledScene scene = balls(2000, 0.5, kUnion);
  CHECK_FALSE(builds(scene, 5e5));
  CHECK(builds(scene, 1e8));
}

TEST_CASE("region forecast: leaves that are as expensive as the whole program do not pay", "[field][regions]") {
  // All balls blend with each other everywhere, so no cell has a part that is shorter.
  CHECK_FALSE(builds(balls(600, 0.5, R"("smooth_union", "k": 4)"), 1e8));
  CHECK(builds(balls(600, 0.02, R"("smooth_union", "k": 0.02)"), 1e8));
}

TEST_CASE("region forecast: without limits the leaves have the normal number of choices", "[field][regions]") {
  const compiler::CompiledScene scene = balls(2000, 0.02, kUnion);
  runtime::Field field = runtime::make_field(scene);
  add_regions(field, scene, {});
  REQUIRE(field.regions);
  std::size_t longest = 0;
  test::Random random(1);
  for (int i = 0; i < 200; ++i) {
    longest = std::max<std::size_t>(longest, field.regions->region(random.in_box(1)).part.choices);
  }
  CAPTURE(longest);
  CHECK(longest <= runtime::kLeafChoices);
}

}  // namespace
}  // namespace fathom::region_forecast_test
