#include "runtime/path/surface.h"

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>

#include "runtime/field/field.h"
#include "tests/runtime/scenes.h"

namespace fathom::runtime::surface_test {
namespace {

SurfacePoint find(const compiler::CompiledScene& scene, const Hit& hit) {
  vm::Workspace workspace;
  SurfacePoint point;
  find_surfaces(scene, make_field(scene), std::span(&hit, 1), std::span(&point, 1), workspace);
  return point;
}

TEST_CASE("surface: the normal faces the ray, on either side", "[runtime]") {
  const auto scene = scene_of(R"("objects": [{"type": "sphere", "radius": 2}])");
  const SurfacePoint outside = find(scene, {{0, 2, 0}, {0, 1, 0}, 1, 1e-7f});
  const SurfacePoint inside = find(scene, {{0, 2, 0}, {0, -1, 0}, -1, 1e-7f});
  CHECK(glm::length(outside.normal - glm::vec3(0, 1, 0)) < 1e-6f);
  CHECK(glm::length(inside.normal - glm::vec3(0, -1, 0)) < 1e-6f);
}

TEST_CASE("surface: each object's material is its own", "[runtime]") {
  const auto scene = scene_of(R"("materials": {"a": {"type": "diffuse"}, "b": {"type": "specular"}},
      "objects": [{"type": "sphere", "radius": 1, "material": "a"},
                  {"type": "sphere", "radius": 1, "translate": [3, 0, 0], "material": "b"}])");
  const auto name = [&](glm::dvec3 at) { return scene.materials[find(scene, {at, {0, 1, 0}, 1, 0}).material].name; };
  CHECK(name({0, 1, 0}) == "a");
  CHECK(name({3, 1, 0}) == "b");
}

TEST_CASE("surface: without a gradient the normal is the way back", "[runtime]") {
  const auto scene = scene_of(R"("objects": [{"type": "sphere", "radius": 1}])");
  CHECK(find(scene, {{0, 0, 0}, {0, 0, 1}, 1, 0}).normal == glm::vec3(0, 0, 1));
}

TEST_CASE("surface: new rays start clear of the surface, on the side asked for", "[runtime]") {
  const auto scene = scene_of(R"("objects": [{"type": "sphere", "radius": 1}])");
  const Hit hit{{0, 1, 0}, {0, 1, 0}, 1, 1e-7f};
  const SurfacePoint point = find(scene, hit);
  CHECK(point.offset == Approx(16 * kDistanceError));
  CHECK(spawn_origin(hit, point, false).y > 1 + 15 * static_cast<double>(kDistanceError));
  CHECK(spawn_origin(hit, point, true).y < 1 - 15 * static_cast<double>(kDistanceError));
  CHECK(find(scene, {{0, 1, 0}, {0, 1, 0}, 1, 1e-3f}).offset == Approx(2e-3f));
}

}  // namespace
}  // namespace fathom::runtime::surface_test
