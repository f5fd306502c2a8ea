// The live page: what it holds, and that no name of a scene gets out of its place in it. That browsers draw it is a
// matter of a browser.
#include "runtime/live/live_page.h"

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "tests/support/catch.h"
#include "tests/support/compiled.h"
#include "tests/support/not_run.h"
#include "tests/support/temporary_folder.h"

namespace fathom::test::live_page_test {
namespace {

using nlohmann::json;

// Returns the text between `begin` and the next `end`.
std::string between(const std::string& text, const std::string& begin, const std::string& end) {
  const std::size_t at = text.find(begin);
  REQUIRE(at != text.npos);
  const std::size_t first = at + begin.size();
  return text.substr(first, text.find(end, first) - first);
}

json scene_of(const std::string& page) {
  return json::parse(between(page, "<script type=\"application/json\" id=\"scene\">", "</script>"));
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != text.npos; at = text.find(part, at + 1)) ++found;
  return found;
}

constexpr const char* kScene = R"({"version": 1,
  "materials": {"metal": {"type": "principled", "base_color": [0.1, 0.2, 0.3], "roughness": 0.4, "metalness": 1},
                "glow": {"type": "emissive", "emission": [4, 4, 4]}},
  "objects": [{"name": "ball", "type": "sphere", "radius": 0.5, "translate": [1, 0, 0], "material": "metal"},
              {"name": "lamp", "type": "sphere", "radius": 0.1, "translate": [0, 2, 0], "material": "glow"}],
  "lights": {"sun": {"type": "directional", "direction": [0, -1, 0], "irradiance": [2, 2, 2]}},
  "camera": {"position": [0, 0, 5], "target": [0, 0, 0], "fov": 90},
  "film": {"width": 200, "height": 100, "exposure": 1}})";

}  // namespace

TEST_CASE("a live page has the scene's functions, camera, materials and lights", "[live]") {
  const std::string page = runtime::live_page(test::compiled(kScene));
  const json scene = scene_of(page);
  const std::string shader = scene["shader"];
  CHECK(count(shader, "float scene_distance(vec3 p) {") == 1);
  CHECK(count(shader, "int scene_surface(vec3 p) {") == 1);
  CHECK(count(shader, "kSurfaces = 2;") == 1);
  CHECK(scene["exposure"] == 2);
  CHECK(scene["camera"]["position"] == json({0, 0, 5}));
  CHECK(scene["camera"]["half"][0].get<double>() == Approx(1));
  CHECK(scene["camera"]["half"][1].get<double>() == Approx(0.5));
  REQUIRE(scene["surfaces"].size() == 2);
  CHECK(scene["surfaces"][0]["name"] == "ball");
  CHECK(scene["surfaces"][0]["color"][2].get<double>() == Approx(0.3));
  CHECK(scene["surfaces"][0]["metalness"] == 1);
  CHECK(scene["surfaces"][1]["emission"] == json({4, 4, 4}));
  REQUIRE(scene["lights"].size() == 2);
  CHECK(scene["lights"][0]["at"] == json({0, 1, 0, 0}));
  CHECK(scene["lights"][1]["at"] == json({0, 2, 0, 1}));
  CHECK(scene["lights"][1]["power"][0].get<double>() == Approx(4 * 3.14159265 * 0.01));
  CHECK(scene["box"][1][0].get<double>() == Approx(1.5).margin(0.1));
}

TEST_CASE("a live page of an unbounded scene has a box without end, but a slice of its bounded parts", "[live]") {
  const json scene = scene_of(runtime::live_page(
      compiled_objects(R"({"type": "plane", "normal": [0, 1, 0]}, {"type": "sphere", "radius": 2})")));
  REQUIRE(scene["slice"].is_array());
  CHECK(scene["slice"][0][0].get<double>() == Approx(-2).margin(0.1));
  CHECK(scene["slice"][1][2].get<double>() == Approx(2).margin(0.1));
  CHECK(scene["box"][0][0] == -1e20);
}

// Sides of a live page's box without end, and of an empty scene, have no number in JSON.
TEST_CASE("the values of a live page are finite", "[live]") {
  const std::string apart = R"({"type": "intersection", "of": [{"type": "sphere", "radius": 1},
                                {"type": "sphere", "radius": 1, "translate": [9, 0, 0]}]})";
  for (const std::string& object : {std::string(R"({"type": "plane", "normal": [0, 1, 0]})"), apart}) {
    const json scene = scene_of(runtime::live_page(compiled_objects(object)));
    for (const char* box : {"box", "slice", "sliceBox"}) {
      for (int side = 0; side < 2; ++side) {
        for (int axis = 0; axis < 3; ++axis) CHECK(scene[box][side][axis].is_number());
      }
    }
  }
}

// The page compiles nothing as long as the text stays.
TEST_CASE("the shader of a live page depends on the scene's structure alone", "[live]") {
  const auto page_of = [](const std::string& size) {
    return scene_of(runtime::live_page(test::compiled(R"({"version": 1,
      "materials": {"paint": {"type": "diffuse", "color": [0.5, 0.5, )" +
                                                      size + R"(]}},
      "objects": [{"type": "box", "half_size": [1, 1, )" +
                                                      size + R"(], "rotate": [0, 30, 0], "material": "paint"}],
      "camera": {"position": [0, 0, 5], "target": [0, )" +
                                                      size + R"(, 0]}})")));
  };
  const json a = page_of("0.25"), b = page_of("0.125");
  CHECK(a["shader"] == b["shader"]);
  CHECK(a["numbers"] != b["numbers"]);
}

TEST_CASE("the shader of a live page is GLSL ES 3.00", "[live]") {
  if (std::string_view(FATHOM_GLSLANG).empty()) return test::not_run("glslangValidator is missing");
  const test::TemporaryFolder folder;
  const std::string shader = scene_of(runtime::live_page(test::compiled(kScene)))["shader"];
  for (const char* defined : {"", "#define COPY_NUMBERS\n"}) {
    std::ofstream(folder.path() / "live.frag") << "#version 300 es\n"
                                               << defined << "precision highp float;\nprecision highp int;\n"
                                               << shader;
    const std::string command = "cd '" + folder.path().string() + "' && '" FATHOM_GLSLANG "' live.frag > log";
    const int status = std::system(command.c_str());
    std::string line;
    for (std::ifstream log(folder.path() / "log"); std::getline(log, line);) UNSCOPED_INFO(line);
    CHECK(status == 0);
  }
}

TEST_CASE("a live page knows how far the distance to each surface can be trusted", "[live]") {
  const json scene = scene_of(runtime::live_page(compiled_objects(
      R"({"name": "a", "type": "sphere", "radius": 1, "translate": [9, 0, 0]},
         {"name": "b", "type": "mandelbulb"},
         {"name": "c", "type": "intersection", "translate": [-9, 0, 0],
          "of": [{"type": "sphere", "radius": 1}, {"type": "box", "half_size": [0.8, 0.8, 0.8]}]})")));
  CHECK(scene["surfaces"].size() == 3);
  // 2 bits each: exact 0, an estimate 2, a bound 1.
  CHECK(scene["exactness"] == json({24}));
}

TEST_CASE("a textured surface of a live page has the mean colour that the camera sees", "[live]") {
  const json scene = scene_of(runtime::live_page(test::compiled(R"({"version": 1,
    "materials": {"ramp": {"type": "diffuse", "color": {"pattern": "gradient", "from": [0, -1, 0], "to": [0, 1, 0],
                                                        "a": [0, 0, 0], "b": [0.8, 0.4, 0]}}},
    "objects": [{"name": "wall", "type": "box", "half_size": [1, 1, 0.1], "material": "ramp"}],
    "camera": {"position": [0, 0, 5], "target": [0, 0, 0], "fov": 40}, "film": {"width": 100, "height": 100}})")));
  CHECK(scene["surfaces"][0]["color"][0].get<double>() == Approx(0.4).margin(0.02));
  CHECK(scene["surfaces"][0]["color"][1].get<double>() == Approx(0.2).margin(0.01));
}

// Rays ended before a large scene: a hundred times the distance of a camera that had not been placed yet.
TEST_CASE("rays of a live page reach the scene that its camera frames", "[live]") {
  const json scene = scene_of(runtime::live_page(compiled_objects(R"({"type": "sphere", "radius": 10000})")));
  CHECK(scene["camera"]["position"][2].get<double>() > 10000);
  CHECK(scene["far"].get<double>() > 2 * scene["camera"]["position"][2].get<double>());
}

TEST_CASE("no name of a scene ends its element in a live page", "[live]") {
  const std::string hostile = "</script><script>alert(1)</script><!--*/ \\\" '";
  const std::string page =
      runtime::live_page(compiled_objects("{\"name\": \"" + hostile + "\", \"type\": \"sphere\", \"radius\": 1}"));
  CHECK(count(page, "<script") == 2);
  CHECK(count(page, "</script") == 2);
  CHECK(count(page, "<!--") == 0);
  CHECK(scene_of(page)["surfaces"][0]["name"].get<std::string>().starts_with("</script>"));
}

}  // namespace fathom::test::live_page_test
