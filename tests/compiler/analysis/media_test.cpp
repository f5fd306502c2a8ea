// Interiors of transparent bodies, as the compiler finds them.
#include <fmt/format.h>

#include <string>

#include "tests/support/catch.h"
#include "tests/support/compiled.h"
#include "vm/interpret/evaluate.h"

namespace fathom::compiler::media_test {
namespace {

CompiledScene with(const std::string& materials, const std::string& objects) {
  return test::compiled(R"({"version": 1, "materials": {)" + materials + R"(}, "objects": [)" + objects + "]}");
}

double value(const Medium& medium, glm::dvec3 place) {
  vm::Workspace workspace;
  return vm::evaluate_distance(medium.distance, place, workspace);
}

const char* const kGlassAndWater = R"("table": {"type": "diffuse"}, "glass": {"type": "transparent"},
    "water": {"type": "transparent", "ior": 1.33})";

TEST_CASE("media: one for each transparent material, opaque ones have none", "[analysis]") {
  const CompiledScene scene = with(kGlassAndWater, R"({"type": "sphere", "radius": 1, "material": "glass"},
        {"type": "sphere", "radius": 1, "translate": [5, 0, 0], "material": "glass"},
        {"type": "sphere", "radius": 1, "translate": [9, 0, 0], "material": "water"},
        {"type": "plane", "normal": [0, 1, 0], "offset": -3, "material": "table"})");
  REQUIRE(scene.media.size() == 2);
  CHECK(scene.materials[scene.media[0].material].name == "glass");
  CHECK(value(scene.media[0], {0, 0, 0}) < 0);
  CHECK(value(scene.media[0], {5, 0, 0}) < 0);
  CHECK(value(scene.media[0], {9, 0, 0}) > 0);
  CHECK(value(scene.media[1], {9, 0, 0}) < 0);
  // The program of a medium leaves out bodies that are far away: two spheres here, one sphere there.
  CHECK(scene.media[0].distance.instructions() < scene.distance.instructions());
  CHECK(scene.media[1].distance.instructions() == 1);
  CHECK(with(R"("m": {"type": "diffuse"})", R"({"type": "sphere", "radius": 1, "material": "m"})").media.empty());
}

TEST_CASE("media: what is opaque takes its place from glass, and the first glass from the second", "[analysis]") {
  const std::string bodies = R"({"type": "sphere", "radius": 1, "material": "glass"},
      {"type": "sphere", "radius": 1, "translate": [1, 0, 0], "material": "water"},
      {"type": "plane", "normal": [0, 1, 0], "offset": -0.5, "material": "table"})";
  const CompiledScene scene = with(kGlassAndWater, bodies);
  REQUIRE(scene.media.size() == 2);
  const Medium &glass = scene.media[0], &water = scene.media[1];
  CHECK(value(glass, {0.5, 0, 0}) < 0);
  CHECK(value(water, {0.5, 0, 0}) > 0);
  CHECK(value(water, {1.5, 0, 0}) < 0);
  CHECK(value(glass, {0, -0.7, 0}) > 0);
  CHECK(value(water, {1.5, -0.7, 0}) > 0);

  const CompiledScene turned = with(
      R"("table": {"type": "diffuse"}, "glass": {"type": "transparent"},
         "water": {"type": "transparent", "ior": 1.33, "priority": 1})",
      bodies);
  CHECK(value(turned.media[0], {0.5, 0, 0}) > 0);
  CHECK(value(turned.media[1], {0.5, 0, 0}) < 0);
}

TEST_CASE("media: bodies are told apart within moved groups", "[analysis]") {
  const CompiledScene scene = with(kGlassAndWater, R"({"type": "union", "translate": [3, 0, 0], "of": [
      {"type": "sphere", "radius": 1, "material": "glass"},
      {"type": "box", "half_size": [2, 0.2, 2], "material": "table"}]})");
  REQUIRE(scene.media.size() == 1);
  CHECK(value(scene.media[0], {3, 0.5, 0}) < 0);
  CHECK(value(scene.media[0], {3, 0, 0}) > 0);
  CHECK(value(scene.media[0], {0, 0.5, 0}) > 0);
}

// Each of ten thousand balls in one union was cut by all that the union's box meets.
TEST_CASE("media: a body of a union is cut by what meets its own box", "[analysis]") {
  std::string glass, stones;
  for (int i = 0; i < 20; ++i) {
    glass += fmt::format(R"({}{{"type": "sphere", "radius": 1, "translate": [{}, 0, 0]}})", i > 0 ? ", " : "", 3 * i);
    stones +=
        fmt::format(R"(, {{"type": "sphere", "radius": 1, "translate": [{}, 5, 0], "material": "table"}})", 3 * i);
  }
  const CompiledScene scene =
      with(kGlassAndWater, R"({"type": "union", "material": "glass", "of": [)" + glass + "]}" + stones +
                               R"(, {"type": "sphere", "radius": 0.5, "translate": [3, 0, 0], "material": "table"})");
  REQUIRE(scene.media.size() == 1);
  CHECK(scene.media[0].distance.instructions() < 30);
  CHECK(value(scene.media[0], {3, 0, 0}) > 0);
  CHECK(value(scene.media[0], {3, 0.7, 0}) < 0);
  CHECK(value(scene.media[0], {57, 0, 0}) < 0);
}

// The cuts of n bodies, each by n others, took n^2 nodes.
TEST_CASE("media: bodies that all overlap are cut together", "[analysis]") {
  std::string bodies;
  for (int i = 0; i < 200; ++i) {
    bodies += fmt::format(R"({}{{"type": "sphere", "radius": 1, "translate": [{}, 0, 0], "material": "{}"}})",
                          i > 0 ? ", " : "", 0.001 * i, i % 2 == 0 ? "glass" : "table");
  }
  const CompiledScene scene = with(kGlassAndWater, bodies);
  REQUIRE(scene.media.size() == 1);
  CHECK(scene.media[0].distance.instructions() < 1000);
  CHECK(value(scene.media[0], {0, 0, 0}) > 0);
  CHECK(value(scene.media[0], {-0.9995, 0, 0}) < 0);
}

// Regression: the part without a material of its own was taken for part of its neighbour.
TEST_CASE("media: a body that has its material from above", "[analysis]") {
  const CompiledScene scene = with(kGlassAndWater, R"({"type": "union", "material": "glass", "of": [
      {"type": "sphere", "radius": 1},
      {"type": "sphere", "radius": 1, "translate": [5, 0, 0], "material": "table"}]})");
  REQUIRE(scene.media.size() == 1);
  CHECK(value(scene.media[0], {0, 0, 0}) < 0);
  CHECK(value(scene.media[0], {5, 0, 0}) > 0);
}

}  // namespace
}  // namespace fathom::compiler::media_test
