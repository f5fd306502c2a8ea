// Staging of imported models: the front end adds a ground, a light and a camera.
#include "compiler/frontend/stage.h"

#include <string>

#include "compiler/compile.h"
#include "compiler/scene/lowest.h"
#include "tests/support/catch.h"
#include "vm/interpret/evaluate.h"

namespace fathom::compiler::stage_test {
namespace {

// Half a ball of radius 0.6 with its flat side up, and a thin leg down to y = -0.8.
const char* const kBowl =
    "x var-x\ny var-y\nz var-z\nxx square x\nyy square y\nzz square z\na add xx yy\nb add a zz\nc sqrt b\n"
    "r const 0.6\nball sub c r\nbowl max ball y\np add xx zz\nq sqrt p\nw const 0.05\npole sub q w\nl const -0.8\n"
    "under sub l y\nleg max pole under\nshort max leg y\nall min bowl short\n";
const char* const kDisk = "x var-x\ny var-y\na square x\nb square y\nc add a b\nd sqrt c\nr const 0.5\ne sub d r\n";
const char* const kBall = R"({
  "aabb_min": [-1, -1, -1], "aabb_max": [1, 1, 1], "nodeType": "primitive", "primitiveType": "sphere", "radius": 0.5,
  "color": [1, 0, 0], "matrix": [1, 0, 0, 0.4, 0, 1, 0, 3, 0, 0, 1, 0]})";

CompiledScene compiled(const std::string& text, bool stage) {
  Diagnostics diagnostics;
  CompileOptions options;
  options.stage = stage;
  auto scene = compile(Source("model", text), diagnostics, options);
  REQUIRE(scene);
  return std::move(*scene);
}

double distance(const CompiledScene& scene, const glm::dvec3& p) {
  vm::Workspace workspace;
  return vm::evaluate_distance(scene.distance, p - scene.origin, workspace);
}

}  // namespace

TEST_CASE("stage: the lowest point of a solid, to a thousandth of its box", "[frontend]") {
  const CompiledScene bowl = compiled(kBowl, false);
  CHECK(lowest(bowl.distance, bowl.extent) == Approx(-0.8).margin(2e-3));
  // The box contains nothing solid.
  CHECK(lowest(bowl.distance, {glm::dvec3(-1, 0.5, -1), glm::dvec3(1, 1, 1)}) == 0.5);
}

TEST_CASE("stage: a model stands on a ground, is lit, and is framed", "[frontend]") {
  for (const auto& [text, bottom] : {std::pair(kBowl, -0.8), std::pair(kBall, -3.5)}) {
    CAPTURE(text);
    const CompiledScene bare = compiled(text, false), staged = compiled(text, true);
    CHECK(bare.lights.empty());
    CHECK(!bare.camera.automatic);
    REQUIRE(staged.lights.size() == 1);
    CHECK(staged.camera.automatic);
    CHECK(staged.surfaces.size() == bare.surfaces.size() + 1);
    // Far from the model there is only the ground. The model touches the ground.
    CHECK(distance(staged, {40, bottom + 1, 0}) == Approx(1).margin(3e-3));
    CHECK(distance(bare, {40, bottom + 1, 0}) > 30);
    CHECK(distance(bare, {text == kBall ? -0.4 : 0.0, bottom, 0}) == Approx(0).margin(3e-3));
    // Three-quarter view from above, with the whole model in the image.
    const glm::dvec3 towards = staged.camera.target - staged.camera.position;
    CHECK(towards.y < 0);
    CHECK(staged.camera.position.y + staged.origin.y > bottom + 1);
  }
}

TEST_CASE("stage: drawings and scenes of this format have none", "[frontend]") {
  const CompiledScene drawing = compiled(kDisk, true);
  CHECK(drawing.lights.empty());
  CHECK(drawing.surfaces.size() == 1);
  CHECK(drawing.camera.projection == Camera::Projection::Orthographic);
  const char* const kScene = R"({"version": 1, "objects": [{"type": "sphere", "radius": 1}]})";
  CHECK(compiled(kScene, true).surfaces.size() == 1);
}

TEST_CASE("stage: a model with a mistake is reported once", "[frontend]") {
  Diagnostics diagnostics;
  CompileOptions options;
  options.stage = true;
  CHECK(!compile(Source("model", "x var-x\nz var-z\na add x y\n"), diagnostics, options));
  CHECK(diagnostics.errors() == 1);
}

}  // namespace fathom::compiler::stage_test
