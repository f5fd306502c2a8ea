#include "compiler/analysis/formula_cells.h"

#include <string>

#include "tests/support/catch.h"
#include "tests/support/compiled.h"

namespace fathom::compiler::formula_cells_test {
namespace {

CompiledScene with_objects(const std::string& objects) {
  return test::compiled(R"({"version": 1, "background": [1, 1, 1], "objects": [)" + objects + "]}");
}

const std::string kStairs =
    R"_({"type": "expression", "formula": "y - 0.5 * floor(x)", "half_size": [1, 2, 3], "translate": [5, 0, 0]})_";
const std::string kGround = R"({"type": "plane", "normal": [0, 1, 0], "offset": -2})";

TEST_CASE("formula cells: a formula that jumps is proved in cells of its box", "[analysis]") {
  const CompiledScene alone = with_objects(kStairs);
  CHECK(!alone.certified);
  CHECK(alone.formula_box.hi.x - alone.formula_box.lo.x == Approx(2));
  CHECK(alone.formula_box.hi.z - alone.formula_box.lo.z == Approx(6));
  CHECK(alone.rest_lipschitz == 0);
  const CompiledScene grounded = with_objects(kStairs + "," + kGround);
  CHECK(grounded.formula_box.finite());
  CHECK(grounded.rest_lipschitz == 1);
}

TEST_CASE("formula cells: what is proved as a whole needs no cells", "[analysis]") {
  const CompiledScene smooth = with_objects(R"_({"type": "expression", "formula": "y - sin(x)"})_");
  CHECK(smooth.certified);
  CHECK(smooth.formula_box.empty());
}

// The constant of the heart holds at the corners of its box, where it is 1000 times as steep as at its surface.
TEST_CASE("formula cells: a formula that is steep only far from its surface is proved, and has cells", "[analysis]") {
  const std::string heart = R"_({"type": "expression", "half_size": [1.4, 1.4, 1.4],
      "formula": "(x^2 + 2.25 * z^2 + y^2 - 1)^3 - x^2 * y^3 - 0.1125 * z^2 * y^3"})_";
  const CompiledScene scene = with_objects(heart + "," + kGround);
  CHECK(scene.certified);
  CHECK(scene.formula_box.finite());
  CHECK(scene.rest_lipschitz == 1);
  CHECK(scene.cancellation < 1);
  CHECK(with_objects(R"_({"type": "expression", "formula": "40 * (y - sin(x))", "half_size": [1, 1, 1]})_")
            .formula_box.empty());
}

TEST_CASE("formula cells: neither fractals nor formulas that jump everywhere are proved in cells", "[analysis]") {
  const std::string everywhere = R"_({"type": "expression", "formula": "y - floor(4000 * x)"})_";
  CHECK(with_objects(everywhere).formula_box.empty());
  CHECK(with_objects(R"({"type": "mandelbulb"})").formula_box.empty());
  CHECK(with_objects(kStairs + R"(, {"type": "mandelbulb"})").formula_box.empty());
}

TEST_CASE("formula cells: a formula blended with an endless part has no cells", "[analysis]") {
  CHECK(with_objects(R"({"type": "smooth_union", "k": 0.1, "of": [)" + kStairs + "," + kGround + "]}")
            .formula_box.empty());
  CHECK(with_objects(R"({"type": "smooth_union", "k": 0.1, "of": [)" + kStairs +
                     R"(, {"type": "sphere", "radius": 1}]})")
            .formula_box.finite());
}

}  // namespace
}  // namespace fathom::compiler::formula_cells_test
