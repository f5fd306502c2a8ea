#include "runtime/certify.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <glm/geometric.hpp>

#include "tests/runtime/scenes.h"

namespace fathom::runtime {
namespace {

using Outcome = Certified::Outcome;

TEST_CASE("certify: first roots of a sphere, from outside and from within", "[march]") {
  const auto scene = scene_of(R"("objects": [{"type": "sphere", "radius": 1}])");
  const Field field = make_field(scene);
  vm::Workspace workspace;
  const Certified outside = certify(field, {0.5, 0, 5}, {0, 0, -1}, 1, 0, 10, workspace);
  CHECK(outside.outcome == Outcome::Hit);
  CHECK(std::abs(outside.t - (5 - std::sqrt(0.75))) <= 2.4e-7);
  CHECK(outside.width <= 2.4e-7);
  const Certified inside = certify(field, {0.5, 0, 0}, {0, 0, -1}, -1, 0, 10, workspace);
  CHECK(inside.outcome == Outcome::Hit);
  CHECK(std::abs(inside.t - std::sqrt(0.75)) <= 2.4e-7);
  CHECK(certify(field, {1.001, 0, 5}, {0, 0, -1}, 1, 0, 10, workspace).outcome == Outcome::Miss);
}

TEST_CASE("certify: the end of the segment counts", "[march]") {
  const auto scene = scene_of(R"("objects": [{"type": "sphere", "radius": 1}])");
  const Field field = make_field(scene);
  vm::Workspace workspace;
  CHECK(certify(field, {0, 0, 5}, {0, 0, -1}, 1, 0, 3.999, workspace).outcome == Outcome::Miss);
  CHECK(certify(field, {0, 0, 5}, {0, 0, -1}, 1, 0, 4.001, workspace).outcome == Outcome::Hit);
}

TEST_CASE("certify: a touch without a crossing is a miss, and is reported", "[march]") {
  const auto scene = scene_of(R"("objects": [{"type": "sphere", "radius": 1}])");
  const Field field = make_field(scene);
  vm::Workspace workspace;
  // Askew to the axes: along one, interval arithmetic is exact and would settle even this.
  const glm::dvec3 along = glm::normalize(glm::dvec3(1, 2, 3)), aside = glm::normalize(glm::dvec3(2, -1, 0));
  const Certified touch = certify(field, (1 + 1e-12) * aside - 5.0 * along, along, 1, 0, 10, workspace);
  CHECK(touch.outcome == Outcome::Miss);
  CHECK(touch.contact);
  CHECK_FALSE(certify(field, 1.01 * aside - 5.0 * along, along, 1, 0, 10, workspace).contact);
}

TEST_CASE("certify: intervals settle a long ray along a plane in a few evaluations", "[march]") {
  const auto scene = scene_of(R"("objects": [{"type": "plane", "normal": [0, 1, 0]}])");
  const Field field = make_field(scene);
  vm::Workspace workspace;
  const Certified along = certify(field, {0, 1e-6, 0}, {1, 0, 0}, 1, 0, 1e4, workspace);
  CHECK(along.outcome == Outcome::Miss);
  CHECK(along.evaluations < 10);
  const double slope = 1e-6;
  const Certified down = certify(field, {0, 1e-3, 0}, {1, -slope, 0}, 1, 0, 1e4, workspace);
  REQUIRE(down.outcome == Outcome::Hit);
  CHECK(down.t == Approx(1000).epsilon(1e-6));
  CHECK(down.evaluations < 200);
}

}  // namespace
}  // namespace fathom::runtime
