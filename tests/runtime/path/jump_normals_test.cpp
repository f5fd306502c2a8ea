#include "runtime/path/jump_normals.h"

#include <glm/geometric.hpp>

#include "runtime/path/surface.h"
#include "tests/runtime/scenes.h"
#include "tests/support/catch.h"

namespace fathom::runtime::jump_normals_test {
namespace {

glm::vec3 normal_at(const Field& field, const compiler::CompiledScene& scene, glm::dvec3 at, glm::dvec3 wo) {
  const Hit hit{at, glm::vec3(glm::normalize(wo)), 1, 1e-8f};
  SurfacePoint point;
  vm::Workspace workspace;
  find_surfaces(scene, field, {&hit, 1}, {&point, 1}, workspace);
  return point.normal;
}

TEST_CASE("jump normals: a step's riser faces the side, not the way of the gradient", "[path]") {
  const auto scene =
      scene_of(R"_("objects": [{"type": "expression", "formula": "y - 0.5 * floor(x)", "half_size": [3, 3, 3]}])_");
  const Field field = make_field(scene);
  // The riser at x = 1 goes from y = 0 to 0.5, and is seen from -x.
  for (const glm::dvec3 wo : {glm::dvec3(-1, 0.2, 0), glm::dvec3(-1, 1, 0.5), glm::dvec3(-0.3, -0.1, 1)}) {
    CAPTURE(wo.x, wo.y, wo.z);
    CHECK(glm::length(normal_at(field, scene, {1, 0.25, 0.1}, wo) - glm::vec3(-1, 0, 0)) < 1e-5f);
  }
  // The treads keep the gradient's normal.
  CHECK(glm::length(normal_at(field, scene, {1.5, 0.5, 0.1}, {-1, 1, 0}) - glm::vec3(0, 1, 0)) < 1e-5f);
}

TEST_CASE("jump normals: a slanted wall between slopes faces as it stands", "[path]") {
  const auto scene = scene_of(
      R"_("objects": [{"type": "expression", "formula": "y - 0.5 * x - step(0, x - 0.3 * y)", "half_size": [3, 3, 3]}])_");
  const Field field = make_field(scene);
  // At x = 0.3 y the solid's top rises by 1.
  const glm::dvec3 at(0.15, 0.5, 0.2);
  const glm::vec3 expected = glm::normalize(glm::vec3(-1, 0.3f, 0));
  CHECK(glm::length(normal_at(field, scene, at, {-1, 0.5, 0.2}) - expected) < 1e-5f);
}

}  // namespace
}  // namespace fathom::runtime::jump_normals_test
