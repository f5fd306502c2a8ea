// Colours written as sRGB codes, and translations of outlines written as two numbers.
#include <string>

#include "compiler/compile.h"
#include "tests/compiler/frontend/elaborate/elaborated.h"
#include "tests/support/catch.h"
#include "tests/support/compiled.h"

namespace fathom::test::color_text_test {
namespace {

glm::dvec3 color_of(const std::string& color) {
  const compiler::CompiledScene scene = test::compiled(
      R"({"version": 1, "background": )" + color + R"(, "materials": {"m": {"type": "diffuse", "color": )" + color +
      R"(}}, "objects": [{"type": "sphere", "radius": 1, "material": "m"}]})");
  CHECK(scene.background.top == scene.materials.at(0).color);
  return scene.materials.at(0).color;
}

std::string extruded(const std::string& translate) {
  return listing(of_objects(
      R"({"type": "extrude", "half_depth": 1, "of": {"type": "circle", "radius": 1, "translate": )" + translate + "}}"));
}

}  // namespace

TEST_CASE("a colour as a screen shows it is decoded by the sRGB curve", "[frontend][elaborate]") {
  CHECK(color_of(R"("#000000")") == glm::dvec3(0));
  CHECK(color_of(R"("#ffffff")") == glm::dvec3(1));
  CHECK(color_of(R"("#FFF")") == glm::dvec3(1));
  CHECK(color_of(R"("#c42")") == color_of(R"("#cc4422")"));
  const glm::dvec3 color = color_of(R"("#800a40")");
  CHECK(color.r == Approx(0.21586050011389926).epsilon(1e-12));  // ((128/255 + 0.055) / 1.055)^2.4
  CHECK(color.g == Approx(10 / 255.0 / 12.92).epsilon(1e-12));   // on the linear piece of the curve
  CHECK(color.b == Approx(0.05126945837404324).epsilon(1e-12));
}

TEST_CASE("a colour can be named as in CSS", "[frontend][elaborate]") {
  CHECK(color_of(R"("tomato")") == color_of(R"("#ff6347")"));
  CHECK(color_of(R"("tan")") == color_of(R"("#d2b48c")"));  // also a function, which no formula is
  CHECK(color_of(R"("aliceblue")") == color_of(R"("#f0f8ff")"));
  CHECK(color_of(R"("yellowgreen")") == color_of(R"("#9acd32")"));
  // A parameter of that name is meant, as before there were names.
  const compiler::CompiledScene scene = test::compiled(
      R"({"version": 1, "params": {"red": 0.25}, "background": "red", "materials": {"m": {"type": "diffuse",
      "color": "red"}}, "objects": [{"type": "sphere", "radius": 1, "material": "m"}]})");
  CHECK(scene.background.top == glm::dvec3(0.25));
  CHECK(scene.materials.at(0).color == glm::dvec3(0.25));
}

TEST_CASE("a number is a grey background, as it is a grey colour", "[frontend][elaborate]") {
  const auto scene = test::compiled("fathom 1\nparam p = 0.5\nbackground p*3\nobject sphere(1)\n");
  CHECK(scene.background.top == glm::dvec3(1.5));
  CHECK(scene.background.bottom == glm::dvec3(1.5));
}

TEST_CASE("an outline is moved by two numbers as by three of which the last is 0", "[frontend][elaborate]") {
  CHECK(extruded(R"([1, "2 + 1"])") == extruded("[1, 3, 0]"));
}

}  // namespace fathom::test::color_text_test
