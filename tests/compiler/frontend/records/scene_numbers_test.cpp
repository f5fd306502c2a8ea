// The numbers of a scene: formulas in place of numbers, parameters, and values that are not numbers.
#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "compiler/frontend/elaborate/elaborate.h"
#include "compiler/frontend/formats/print_syntax.h"
#include "compiler/frontend/records/written_numbers.h"
#include "compiler/frontend/syntax/json.h"
#include "tests/compiler/frontend/elaborate/elaborated.h"
#include "tests/support/catch.h"

namespace fathom::scene_numbers_test {

namespace {

using namespace fathom::compiler;
using namespace fathom::test;

TEST_CASE("numbers that JSON cannot hold are refused all the same", "[frontend][elaborate]") {
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    const Source source("scene.json", R"({"version": 1, "objects": [{"type": "sphere", "radius": 1}]})");
    Diagnostics diagnostics;
    auto file = read_json(source, diagnostics);
    REQUIRE(file.has_value());
    auto& root = std::get<syntax::Record>(file->root.data);
    auto& objects = std::get<syntax::List>(root.properties[1].value->data);
    std::get<syntax::Record>(objects[0].data).properties[1].value->data = bad;
    CHECK(!elaborate(*file, diagnostics));
    CHECK(diagnostics.all().at(0).code == "E0301");
  }
}

// Scene text with every numeric property, with r = 2: as numbers or as formulas.
std::string every_number(bool formulas) {
  const auto number = [&](const char* literal, const char* formula) {
    return formulas ? fmt::format("\"{}\"", formula) : std::string(literal);
  };
  const std::string two = number("2", "r"), half = number("0.5", "1/r"), minus = number("-2", "-r");
  const std::string vector = fmt::format("[{}, {}, 3]", two, minus), color = fmt::format("[{0}, 0.25, {0}]", half);
  std::string text =
      fmt::format(R"("version": 1, "params": {{"r": 2}},
      "camera": {{"position": {0}, "target": [0, 0, {1}], "up": [0, {1}, 0], "fov": {2}}},
      "film": {{"width": {3}, "height": {4}, "exposure": {5}}},
      "render": {{"spp": {4}, "rr_depth": {1}, "tile": {4}, "seed": {1}, "far": {3}}},
      "background": {{"bottom": {6}, "top": {6}}},)",
                  vector, two, number("45", "90/r"), number("200", "100*r"), number("8", "r^3"), minus, color);
  text += fmt::format(R"("materials": {{"a": {{"type": "diffuse", "color": {0}}},
      "b": {{"type": "emissive", "emission": {0}}},
      "c": {{"type": "transparent", "ior": {1}, "absorption": {0}}}}},)",
                      color, two);
  text += fmt::format(R"("objects": [
      {{"type": "sphere", "radius": {0}, "material": "a", "scale": {0}}},
      {{"type": "box", "half_size": [1, {0}, 1], "material": "b", "scale": [1, 1, {0}], "rotate": [0, {1}, {0}]}},
      {{"type": "mandelbulb", "iterations": {0}, "material": "c", "rotate": {{"axis": [0, 1, {0}], "angle": {1}}}}},
      {{"type": "smooth_union", "k": {0}, "translate": {2}, "of": [
          {{"type": "onion", "thickness": {0}, "of": {{"type": "plane", "normal": {2}, "offset": {0}}}}}]}}])",
                      two, minus, vector);
  return "{" + text + "}";
}

TEST_CASE("formulas stand wherever numbers do", "[frontend][elaborate]") {
  const ElaboratedScene a = elaborated(every_number(false)), b = elaborated(every_number(true));
  CHECK(listing(a) == listing(b));
  CHECK(listing(b).find("sphere radius=2") != std::string::npos);
  CHECK((a.camera.position == b.camera.position && a.camera.target == b.camera.target && a.camera.up == b.camera.up));
  CHECK((b.camera.fov == a.camera.fov && b.camera.position == glm::dvec3(2, -2, 3)));
  CHECK((b.film.width == 200 && b.film.height == 8 && b.film.exposure == -2));
  CHECK((b.settings.spp == 8 && b.settings.rr_depth == 2 && b.settings.tile == 8 && b.settings.seed == 2));
  CHECK(b.settings.far.value() == 200);
  CHECK((b.background.bottom == glm::dvec3(0.5, 0.25, 0.5) && b.background.top == b.background.bottom));
  REQUIRE(b.materials.size() == a.materials.size());
  for (std::size_t i = 0; i < a.materials.size(); ++i) {
    CHECK((a.materials[i].color == b.materials[i].color && a.materials[i].emission == b.materials[i].emission));
    CHECK((a.materials[i].ior == b.materials[i].ior && a.materials[i].absorption == b.materials[i].absorption));
  }
  CHECK(of_objects(R"({"type": "sphere", "radius": 1})", R"(, "background": ["1/2", 1, "3"])").background.top ==
        glm::dvec3(0.5, 1, 3));
  CHECK(of_objects(R"({"type": "sphere", "radius": 1})", R"(, "camera": {"type": "orthographic", "width": "2*3"})")
            .camera.width == 6);
}

TEST_CASE("seeds have 64 bits, in JSON and as formulas", "[frontend][elaborate]") {
  const auto seeds = [](const std::string& seed) {
    const ElaboratedScene e =
        of_objects(R"({"type": "sphere", "radius": 1, "material": "m"})",
                   fmt::format(R"(, "render": {{"seed": {0}}}, "materials": {{"m": {{"type": "diffuse",
            "color": {{"pattern": "noise", "a": 0, "b": 1, "seed": {0}}}}}}})",
                               seed));
    CHECK(std::get<Pattern::Noise>(std::get<Pattern>(e.textures.back()).kind).seed == e.settings.seed);
    return e.settings.seed;
  };
  for (const std::uint64_t seed :
       {std::uint64_t{0}, std::uint64_t{7}, (std::uint64_t{1} << 53) - 1, std::uint64_t{1} << 53,
        (std::uint64_t{1} << 53) + 1, (std::uint64_t{1} << 63) + 1, ~std::uint64_t{0} - 1, ~std::uint64_t{0}}) {
    CHECK(seeds(fmt::format("{}", seed)) == seed);
    CHECK(seeds(fmt::format("\"{}\"", seed)) == seed);
  }
  CHECK(seeds("\"2^53 - 1\"") == (std::uint64_t{1} << 53) - 1);
  CHECK(seeds("3.0") == 3);
}

TEST_CASE("parameters have values, bounds and defaults", "[frontend][elaborate]") {
  const std::string text = R"({"version": 1, "params": {
      "r": {"default": 0.5, "min": 0, "max": "2*2", "doc": "of the ball"},
      "d": "2*r", "h": {"default": "d + 1", "min": "d"}, "k": -3},
      "objects": [{"type": "cylinder", "radius": "r", "half_height": "h - k"}]})";
  const ElaboratedScene e = elaborated(text);
  REQUIRE(e.parameters.size() == 4);
  CHECK((e.parameters[0].name == "r" && e.parameters[0].value == 0.5 && e.parameters[0].min == 0));
  CHECK((e.parameters[0].max == 4 && e.parameters[0].doc == "of the ball"));
  CHECK((e.parameters[1].value == 1 && std::isinf(e.parameters[1].max)));
  CHECK((e.parameters[2].value == 2 && e.parameters[2].min == 1 && e.parameters[3].value == -3));
  CHECK(listing(e).starts_with("%0 = cylinder radius=0.5 half_height=5\n"));

  const ElaboratedScene given = elaborated(text, {{"r", 1}, {"k", 0}, {"r", 4}});
  CHECK((given.parameters[0].value == 4 && given.parameters[1].value == 8 && given.parameters[2].value == 9));
  CHECK(listing(given).starts_with("%0 = cylinder radius=4 half_height=9\n"));
}

TEST_CASE("a parameter in error is one error, wherever it is used", "[frontend][elaborate]") {
  const Source source("scene.json", R"({"version": 1, "params": {"r": "1 +", "s": "2*r"}, "objects": [
      {"type": "sphere", "radius": "r"}, {"type": "round_box", "half_size": ["s", 1, 1], "radius": "r"}]})");
  Diagnostics diagnostics;
  CHECK(!elaborate(*read_json(source, diagnostics), diagnostics));
  REQUIRE(diagnostics.all().size() == 1);
  CHECK(source.text()[diagnostics.all()[0].span.begin - 1] == '+');
}

TEST_CASE("formulas in lists of points, and what is no list of numbers", "[frontend][elaborate]") {
  Diagnostics diagnostics;
  const auto in = [&](const char* json) { return std::move(read_json(Source("", json), diagnostics)->root); };
  const syntax::Value points = in(R"([[0, "2 - 3"], [1, 0], ["2^3", 1]])");
  REQUIRE(has_formulas(points, ValueType::Points));
  auto numbers = evaluated(points, Scope(), diagnostics, false);
  REQUIRE(numbers.has_value());
  CHECK(syntax::print_syntax({std::move(*numbers)}) == syntax::print_syntax({in("[[0, -1], [1, 0], [8, 1]]")}));
  CHECK(has_formulas(in(R"(["1", 2])"), ValueType::Vec2));
  CHECK(!has_formulas(in("[1, 2]"), ValueType::Vec2));
  CHECK(!has_formulas(in(R"(["1", null])"), ValueType::Vec2));
  CHECK(!has_formulas(in(R"(["1", {}])"), ValueType::Vec2));
  CHECK(!has_formulas(in(R"("1")"), ValueType::Vec2));
  CHECK(!has_formulas(in(R"("x")"), ValueType::Formula));
  CHECK(!has_formulas(in(R"(["x"])"), ValueType::Formula));
  CHECK(!has_formulas(in(R"("x")"), ValueType::Text));
  CHECK(diagnostics.all().empty());
}

TEST_CASE("no formula where no number is wanted", "[frontend][elaborate]") {
  const ElaboratedScene e = of_objects(R"({"name": "1 +", "type": "sphere", "radius": 1, "material": "2*r"})",
                                       R"(, "materials": {"2*r": {"type": "diffuse"}}, "$schema": "1 +")");
  CHECK(surfaces(e) == "1 +:2*r ");
}

}  // namespace

}  // namespace fathom::scene_numbers_test
