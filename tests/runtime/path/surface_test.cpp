#include "runtime/path/surface.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <iterator>

#include "runtime/field/field.h"
#include "tests/runtime/scenes.h"
#include "tests/support/catch.h"

namespace fathom::runtime::surface_test {
namespace {

SurfacePoint find(const compiler::CompiledScene& scene, const Hit& hit) {
  vm::Workspace workspace;
  SurfacePoint point;
  find_surfaces(scene, make_field(scene), std::span(&hit, 1), std::span(&point, 1), workspace);
  return point;
}

TEST_CASE("surface: the normal faces the ray, on either side", "[path]") {
  const auto scene = scene_of(R"("objects": [{"type": "sphere", "radius": 2}])");
  const SurfacePoint outside = find(scene, {{0, 2, 0}, {0, 1, 0}, 1, 1e-7f});
  const SurfacePoint inside = find(scene, {{0, 2, 0}, {0, -1, 0}, -1, 1e-7f});
  CHECK(glm::length(outside.normal - glm::vec3(0, 1, 0)) < 1e-6f);
  CHECK(glm::length(inside.normal - glm::vec3(0, -1, 0)) < 1e-6f);
}

TEST_CASE("surface: each object's material is its own", "[path]") {
  const auto scene = scene_of(R"("materials": {"a": {"type": "diffuse"}, "b": {"type": "specular"}},
      "objects": [{"type": "sphere", "radius": 1, "material": "a"},
                  {"type": "sphere", "radius": 1, "translate": [3, 0, 0], "material": "b"}])");
  const auto name = [&](glm::dvec3 at) { return scene.materials[find(scene, {at, {0, 1, 0}, 1, 0}).material].name; };
  CHECK(name({0, 1, 0}) == "a");
  CHECK(name({3, 1, 0}) == "b");
}

TEST_CASE("surface: without a gradient the normal is the way back", "[path]") {
  const auto scene = scene_of(R"("objects": [{"type": "sphere", "radius": 1}])");
  CHECK(find(scene, {{0, 0, 0}, {0, 0, 1}, 1, 0}).normal == glm::vec3(0, 0, 1));
}

TEST_CASE("surface: a gradient that faces away is turned just far enough", "[path]") {
  const auto scene = scene_of(R"("objects": [{"type": "sphere", "radius": 1}])");
  const Field field = make_field(scene);
  SurfaceRows rows{};
  const glm::vec3 wo = glm::normalize(glm::vec3(1, -0.25f, 0.5f));
  // Gradients: across wo, away from it, of no length, not finite, and towards wo, steep and level.
  const glm::vec3 across = glm::normalize(glm::vec3(0.25f, 1, 0) - 1e-3f * wo);
  const glm::vec3 gradients[] = {across, -wo, glm::vec3(0), {INFINITY, 0, 0}, {NAN, 0, 1}, 3.0f * wo, 0.25f * wo};
  for (std::size_t i = 0; i < std::size(gradients); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      rows.gradient[axis][i] = gradients[i][axis];
      rows.wo[axis][i] = wo[axis];
    }
    rows.size[i] = 1;
    rows.side[i] = 1;
    rows.convex[i] = 0.5f;
    rows.width[i] = 1e-7f;
    rows.inverse_slope[i] = 1;
  }
  set_surface_geometry(field, std::size(gradients), rows);
  const auto normal = [&](std::size_t i) {
    return glm::vec3(rows.normal[0][i], rows.normal[1][i], rows.normal[2][i]);
  };
  CHECK(glm::dot(normal(0), wo) == Approx(1e-4).epsilon(0.01));
  CHECK(glm::length(normal(0)) == Approx(1));
  CHECK(glm::length(normal(0) - across) < 2e-3f);
  for (const std::size_t i : {1, 2, 3, 4}) CHECK(normal(i) == wo);
  CHECK(glm::length(normal(5) - wo) < 1e-6f);
  // A ray's way is clear only where the normal is the gradient's.
  for (const std::size_t i : {0, 1, 2, 3, 4}) CHECK(rows.clear[i] == 0);
  CHECK(rows.clear[5] > 0.4f);
  for (const std::size_t i : {2, 3, 4}) CHECK(rows.steepness[i] == 0);
  CHECK(rows.steepness[5] == 1);
  CHECK(rows.steepness[6] == Approx(0.25));
}

// d_f is a longer way where the field is flatter than the bound of its cell.
TEST_CASE("surface: new rays start further from a surface that is flat for its cell", "[path]") {
  const auto scene = scene_of(R"_("objects": [{"type": "expression", "formula": "y - 0.5 * floor(x)",
      "half_size": [2, 2, 2]}])_");
  const Field field = make_field(scene);
  REQUIRE(field.cells);
  SurfaceRows rows{};
  const float lengths[] = {1, 0.25f, 0.01f, 0};
  for (std::size_t i = 0; i < std::size(lengths); ++i) {
    rows.gradient[1][i] = lengths[i];
    rows.wo[1][i] = rows.size[i] = rows.side[i] = rows.inverse_slope[i] = 1;
  }
  set_surface_geometry(field, std::size(lengths), rows);
  CHECK(rows.offset[0] > 0);
  CHECK(rows.offset[1] == Approx(4 * rows.offset[0]));
  CHECK(rows.offset[2] == Approx(kMaxFlatness * rows.offset[0]));
  CHECK(rows.offset[3] == rows.offset[0]);
}

TEST_CASE("surface: new rays start clear of the surface, on the side asked for", "[path]") {
  const auto scene = scene_of(R"("objects": [{"type": "sphere", "radius": 1}])");
  const Hit hit{{0, 1, 0}, {0, 1, 0}, 1, 1e-7f};
  const SurfacePoint point = find(scene, hit);
  CHECK(point.offset == Approx(16 * kDistanceError));
  CHECK(spawn_origin(hit, point, false).y > 1 + 15 * static_cast<double>(kDistanceError));
  CHECK(spawn_origin(hit, point, true).y < 1 - 15 * static_cast<double>(kDistanceError));
  CHECK(find(scene, {{0, 1, 0}, {0, 1, 0}, 1, 1e-3f}).offset == Approx(2e-3f));
}

// A ray from a level surface once expected the slope of the normal, and nearly every first step was too long.
TEST_CASE("surface: a ray expects the slope of the gradient", "[path]") {
  SurfacePoint point{};
  point.normal = {0, 1, 0};
  point.steepness = 0.25f;
  const Hit hit{{0, 0, 0}, {0, 1, 0}, 1, 1e-7f};
  CHECK(spawn_ray(hit, point, {0, 1, 0}, false).slope == Approx(0.25));
  CHECK(spawn_ray(hit, point, {0.8, -0.6, 0}, true).slope == Approx(0.15));
}

}  // namespace
}  // namespace fathom::runtime::surface_test
