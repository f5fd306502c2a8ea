#include "runtime/field/slope_cells.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/field/field.h"
#include "tests/runtime/rays.h"
#include "tests/runtime/scenes.h"
#include "tests/support/catch.h"
#include "tests/support/scaled_cases.h"
#include "vm/encoding/digest.h"

namespace fathom::runtime::slope_cells_test {
namespace {

const std::string kWave = R"({"type": "expression", "formula": "FORMULA", "half_size": [2, 1.5, 1],
    "rotate": [10, 20, 30]})";
const std::string kGround = R"(, {"type": "plane", "normal": [0, 1, 0], "offset": -1})";

const std::string kHeart = "(x^2 + 2.25 * z^2 + y^2 - 1)^3 - x^2 * y^3 - 0.1125 * z^2 * y^3";

compiler::CompiledScene scene_with(const std::string& formula, bool ground) {
  std::string object = kWave;
  object.replace(object.find("FORMULA"), 7, formula);
  return scene_of("\"objects\": [" + object + (ground ? kGround : "") + "]");
}

TEST_CASE("slope cells: a ball of a point's radius holds no zero", "[field]") {
  Random random(3);
  for (const std::string formula :
       {"y - 0.4 * floor(3 * x + z)", "y - 0.3 * tan(1.3 * x)", "sqrt(abs(x)) - 0.4", kHeart.c_str()}) {
    for (const bool ground : {false, true}) {
      CAPTURE(formula, ground);
      const auto scene = scene_with(formula, ground);
      const Field field = make_field(scene);
      REQUIRE(field.cells);
      RealScratch scratch;
      std::uint64_t instructions = 0;
      int wrong = 0, moved = 0;
      for (int i = 0; i < test::scaled_cases(4000); ++i) {
        const glm::dvec3 point = to_float({random.uniform(-3, 3), random.uniform(-3, 3), random.uniform(-3, 3)});
        const double value = field.evaluate(point, scratch, instructions), radius = field.to_step(value, point);
        wrong += (radius < 0) != (value < 0) && radius != 0;
        moved += std::abs(radius) > 0.01;
        for (int k = 0; k < 8; ++k) {
          const glm::dvec3 other = point + std::abs(radius) * random.uniform(0, 1) * random.direction();
          wrong += (field.evaluate(other, scratch, instructions) < 0) != (value < 0);
        }
      }
      CHECK(wrong == 0);
      CHECK(moved > test::scaled_cases(4000) / 2);
    }
  }
}

TEST_CASE("slope cells: the radius of one point is that of many, on every processor", "[field][isa]") {
  const auto scene = scene_with("y - 0.4 * floor(3 * x + z)", true);
  const Field field = make_field(scene);
  Random random(4);
  std::vector<float> x(80), y(80), z(80), radii(80), values(80);
  for (std::size_t i = 0; i < 64; ++i) {
    x[i] = static_cast<float>(random.uniform(-3, 3));
    y[i] = static_cast<float>(random.uniform(-3, 3));
    z[i] = static_cast<float>(random.uniform(-3, 3));
    radii[i] = values[i] = static_cast<float>(random.uniform(-1, 1));
  }
  values[7] = radii[7] = NAN;
  values[9] = radii[9] = INFINITY;
  field.to_steps({x.data(), y.data(), z.data()}, 61, radii.data());
  CHECK(std::isnan(radii[7]));
  CHECK(std::isfinite(radii[9]));
  for (std::size_t i = 0; i < 61; ++i) {
    if (i != 7)
      CHECK(static_cast<double>(radii[i]) == field.to_step(static_cast<double>(values[i]), {x[i], y[i], z[i]}));
  }
  radii[7] = 0;  // NaNs differ between processors
  const std::string_view bytes(reinterpret_cast<const char*>(radii.data()), 61 * sizeof(float));
  CHECK(vm::digest(bytes).text() == "aa54537c0fbd34cf5daa350a4d97efe0");
}

// A field that is level over most of the cells that may hold a zero has float errors of any size there. Regression:
// their median, 1e29, counted as the error of the whole field.
TEST_CASE("slope cells: a level field has a cancellation of the size of its box", "[field]") {
  const auto scene = scene_with("max(length(x, y, z) - 0.9, 0) + 0.2 * floor(x + 0.99) ", false);
  const Field field = make_field(scene);
  REQUIRE(field.cells);
  CHECK(field.cancellation < 200);
}

TEST_CASE("slope cells: they take little memory", "[field]") {
  const Field field = make_field(scene_with("y - 0.4 * floor(3 * x + z)", true));
  CHECK(field.cells->bytes() < 2u << 20);
}

}  // namespace
}  // namespace fathom::runtime::slope_cells_test
