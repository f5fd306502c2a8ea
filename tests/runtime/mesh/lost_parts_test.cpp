#include "runtime/mesh/lost/lost_parts.h"

#include "tests/runtime/mesh/mesh_checks.h"
#include "tests/support/catch.h"
#include "tests/support/compiled.h"

namespace fathom::lost_parts_test {

namespace {

using namespace fathom::runtime;
using fathom::test::meshed;

std::string objects(const std::string& more) {
  return R"({"version": 1, "objects": [{"name": "block", "type": "box", "half_size": [1, 0.5, 0.5]},)" + more + "]}";
}

}  // namespace

TEST_CASE("lost parts: a thin plate is named, and measured", "[mesh]") {
  const auto scene = test::compiled(
      objects(R"({"name": "plate", "type": "box", "half_size": [0.4, 0.008, 0.4], "translate": [0, 0.813, 0]})"));
  const MeshResult result = meshed(scene, 40);
  REQUIRE(result.end == MeshResult::End::Done);
  CHECK(measure(result.mesh).bodies == 1);
  REQUIRE(result.lost.size() == 1);
  CHECK(scene.surfaces[result.lost[0].surface].name == "plate");
  CHECK_FALSE(result.lost[0].is_gap);
  CHECK(result.lost[0].place.y == Approx(0.813).margin(0.0081));
  CHECK(result.lost[0].thickness == Approx(0.016).margin(result.cell / 16));
  CHECK(result.lost[0].places > 100);
  const MeshResult fine = meshed(scene, 2.4 / 0.016);
  CHECK(fine.lost.empty());
  CHECK(measure(fine.mesh).bodies == 2);
}

TEST_CASE("lost parts: a small ball and a narrow gap are named", "[mesh]") {
  const auto ball = test::compiled(
      objects(R"({"name": "ball", "type": "sphere", "radius": 0.004, "translate": [0.013, 0.7, 0.021]})"));
  const MeshResult without = meshed(ball, 40);
  REQUIRE(without.lost.size() == 1);
  CHECK(ball.surfaces[without.lost[0].surface].name == "ball");
  const auto gap = test::compiled(
      objects(R"({"name": "lid", "type": "box", "half_size": [1, 0.3, 0.5], "translate": [0, 0.803, 0]})"));
  const MeshResult closed = meshed(gap, 40);
  REQUIRE(closed.lost.size() >= 1);
  CHECK(closed.lost[0].is_gap);
  CHECK(closed.lost[0].place.y == Approx(0.5).margin(0.005));
}

TEST_CASE("lost parts: a scene of thick parts loses nothing", "[mesh]") {
  CHECK(meshed(test::compiled(objects(R"({"type": "sphere", "radius": 0.4, "translate": [0, 0.6, 0]})")), 40)
            .lost.empty());
}

}  // namespace fathom::lost_parts_test
