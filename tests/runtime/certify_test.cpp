#include "runtime/certify.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <glm/geometric.hpp>

#include "tests/runtime/scenes.h"

namespace fathom::runtime {
namespace {

using Status = Arrival::Status;

TEST_CASE("certify: first roots of a sphere, from outside and from within", "[march]") {
  const auto scene = scene_of(R"("objects": [{"type": "sphere", "radius": 1}])");
  const Field field = make_field(scene);
  vm::Workspace workspace;
  const Certified outside = certify(field, {0.5, 0, 5}, {0, 0, -1}, 1, {0, 10, 0}, workspace);
  CHECK(outside.status == Status::Hit);
  CHECK(std::abs(outside.t - (5 - std::sqrt(0.75))) <= 1e-12);
  CHECK(outside.width <= 1e-12);
  const Certified inside = certify(field, {0.5, 0, 0}, {0, 0, -1}, -1, {0, 10, 0}, workspace);
  CHECK(inside.status == Status::Hit);
  CHECK(std::abs(inside.t - std::sqrt(0.75)) <= 1e-12);
  CHECK(certify(field, {1.001, 0, 5}, {0, 0, -1}, 1, {0, 10, 0}, workspace).status == Status::Miss);
}

TEST_CASE("certify: the end of the segment counts", "[march]") {
  const auto scene = scene_of(R"("objects": [{"type": "sphere", "radius": 1}])");
  const Field field = make_field(scene);
  vm::Workspace workspace;
  CHECK(certify(field, {0, 0, 5}, {0, 0, -1}, 1, {0, 3.999, 0}, workspace).status == Status::Miss);
  CHECK(certify(field, {0, 0, 5}, {0, 0, -1}, 1, {0, 4.001, 0}, workspace).status == Status::Hit);
}

TEST_CASE("certify: a touch without a crossing is a contact", "[march]") {
  const auto box = scene_of(R"("objects": [{"type": "box", "half_size": [1, 1, 1]}])");
  const auto ball = scene_of(R"("objects": [{"type": "sphere", "radius": 1}])");
  const Field box_field = make_field(box), ball_field = make_field(ball);
  vm::Workspace workspace;
  // Past an edge of the box.
  const glm::dvec3 along = glm::normalize(glm::dvec3(1, -1, 0.5));
  const auto past_edge = [&](double gap) {
    return certify(box_field, glm::dvec3(1 + gap, 1 + gap, 0) - 5.0 * along, along, 1, {0, 10, 0}, workspace).status;
  };
  CHECK(past_edge(1e-13) == Status::Contact);
  CHECK(past_edge(1e-10) == Status::Miss);
  // A curve is nearly level where it touches: what the derivative excludes takes no resolution.
  const glm::dvec3 aside = glm::normalize(glm::dvec3(2, -1, 0)), by = glm::normalize(glm::dvec3(1, 2, 3));
  const auto past_ball = [&](double gap) {
    return certify(ball_field, (1 + gap) * aside - 5.0 * by, by, 1, {0, 10, 0}, workspace);
  };
  CHECK(past_ball(1e-13).status == Status::Miss);
  CHECK(past_ball(1e-13).evaluations < 100);
  CHECK(past_ball(-1e-13).status == Status::Hit);
}

TEST_CASE("certify: intervals settle a long ray along a plane in a few evaluations", "[march]") {
  const auto scene = scene_of(R"("objects": [{"type": "plane", "normal": [0, 1, 0]}])");
  const Field field = make_field(scene);
  vm::Workspace workspace;
  const Certified along = certify(field, {0, 1e-6, 0}, {1, 0, 0}, 1, {0, 1e4, 0}, workspace);
  CHECK(along.status == Status::Miss);
  CHECK(along.evaluations < 10);
  const double slope = 1e-6;
  const Certified down = certify(field, {0, 1e-3, 0}, {1, -slope, 0}, 1, {0, 1e4, 0}, workspace);
  REQUIRE(down.status == Status::Hit);
  CHECK(down.t == Approx(1000).epsilon(1e-6));
  CHECK(down.evaluations < 200);
}

}  // namespace
}  // namespace fathom::runtime
