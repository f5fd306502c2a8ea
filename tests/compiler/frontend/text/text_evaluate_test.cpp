// Evaluation of texts: values, nodes, and the scene that an equivalent JSON file describes.
#include <fmt/format.h>

#include <string>

#include "compiler/compile.h"
#include "compiler/frontend/formats/write_json.h"
#include "compiler/frontend/text/read_text.h"
#include "tests/support/catch.h"

namespace fathom::text_evaluate_test {

namespace {

using namespace fathom::compiler;

// Returns the scene as JSON without its head. `definitions` are those of option -D.
std::string scene_of(const std::string& text, const Definitions& definitions = {}) {
  Source source("a.fathom", "fathom 1\n" + text);
  Diagnostics diagnostics;
  const auto read = read_text_scene(source, definitions, {}, diagnostics);
  INFO(diagnostics.print(source, ErrorFormat::Text));
  REQUIRE((read && !diagnostics.has_errors()));
  std::string json = write_json(read->first);
  std::erase(json, '\n');
  for (std::size_t at = json.find("  "); at != std::string::npos; at = json.find("  ")) json.erase(at, 1);
  const std::string head = "{ \"version\": 1, ";
  REQUIRE(json.starts_with(head));
  return json.substr(head.size(), json.size() - head.size() - 1);
}

// Returns the value of an expression, read from the radius of a ball.
std::string radius(const std::string& expression, const std::string& before = "") {
  const std::string scene = scene_of(before + "\nobject \"it\" sphere(" + expression + ")");
  const std::size_t at = scene.find("\"radius\": ") + 10;
  return scene.substr(at, scene.find(", \"name\"") - at);
}

TEST_CASE("text: arithmetic, comparisons and conditions", "[frontend][text]") {
  CHECK(radius("1 + 2*3 - 4/2") == "5");
  CHECK(radius("2^3^2") == "512");
  CHECK(radius("-2^2 + 8") == "4");
  CHECK(radius("if 1 < 2 && !(3 >= 4) then 5 else 6") == "5");
  CHECK(radius("if \"a\" == \"b\" || 1 != 1 then 5 else 6") == "6");
  CHECK(radius("let a = 2 let b = a + 1 in a*b") == "6");
  CHECK(radius("([1, 2, 3] + 1)[2]") == "4");
  CHECK(radius("(2*[1, 2, 3] - [1, 1, 1]).y") == "3");
  CHECK(radius("dot([1, 2, 3], [4, 5, 6])") == "32");
  CHECK(radius("length([3, 4])") == "5");
  CHECK(radius("normalize([0, 3, 4])[1]") == "0.6");
  CHECK(radius("len([1, 2, ...[3, 4], for i in 0..3: i, if 1 > 2: 9])") == "7");
  CHECK(radius("(a = 1, b = (c = 7)).b.c") == "7");
  CHECK(radius("round(2.6)") == "3");
}

TEST_CASE("text: functions, loops and folds", "[frontend][text]") {
  CHECK(radius("f(2)", "def f(a, b = a + 1) = a*b") == "6");
  CHECK(radius("f(b = 5, a = 2)", "def f(a, b = a + 1) = a*b") == "10");
  CHECK(radius("fold sum = 0 for i in 1..5: sum + i") == "10");
  CHECK(radius("fold best = 0 for v in [3, 7, 5]: if v > best then v else best") == "7");
  CHECK(radius("even(3)", "def even(n) = if mod(n, 2) == 0 then 1 else half(n)\ndef half(n) = n/2") == "1.5");
  CHECK(radius("a", "let a = b + 1\nlet b = 2") == "3");  // definitions may stand in any order
}

// Values of the published generator. Other values would change scenes.
TEST_CASE("text: random numbers are those of SplitMix64", "[frontend][text]") {
  CHECK(radius("random(0)") == "0.8833108082136426");
  CHECK(radius("random(1, 2, 3)") == "0.4175580595044027");
  CHECK(radius("random(-5)") == "0.08865044484243612");
}

TEST_CASE("text: nodes are joined, placed and shared as JSON has them", "[frontend][text]") {
  CHECK(scene_of("object sphere(1) + box([1, 1, 1]) + sphere(2)") ==
        R"("objects": [ { "type": "union", "of": [{"type": "sphere", "radius": 1}, {"type": "box", "half_size": [1, 1, 1]}, {"type": "sphere", "radius": 2}] } ])");
  CHECK(scene_of("object (sphere(1) -{0.1} sphere(2)) & sphere(3)") ==
        R"("objects": [ { "type": "intersection", "of": [ { "type": "smooth_subtraction", "k": 0.1, "of": [{"type": "sphere", "radius": 1}, {"type": "sphere", "radius": 2}] }, {"type": "sphere", "radius": 3} ] } ])");
  CHECK(scene_of("object sphere(1).scale(2).translate([1, 0, 0])") ==
        R"("objects": [{"type": "sphere", "radius": 1, "scale": 2, "translate": [1, 0, 0]}])");
  CHECK(scene_of("object sphere(1).translate([1, 0, 0]).scale(2)") ==
        R"("objects": [{"type": "union", "of": [{"type": "sphere", "radius": 1, "translate": [1, 0, 0]}], "scale": 2}])");
  CHECK(scene_of("object onion(sphere(1), 0.1)") == scene_of("object sphere(1).onion(0.1)"));
  CHECK(scene_of("let a = sphere(1)\nobject a\nobject a.translate([0, 1, 0])") ==
        R"("nodes": {"a": {"type": "sphere", "radius": 1}}, "objects": [{"use": "a"}, {"use": "a", "translate": [0, 1, 0]}])");
  CHECK(scene_of("def twice(part) = part + part.translate([1, 0, 0])\nobject twice(sphere(1))") ==
        R"("nodes": {"part": {"type": "sphere", "radius": 1}}, "objects": [{"type": "union", "of": [{"use": "part"}, {"use": "part", "translate": [1, 0, 0]}]}])");
  CHECK(scene_of("object \"a\" ...[sphere(1), sphere(2)]") ==
        R"("objects": [{"type": "sphere", "radius": 1, "name": "a"}, {"type": "sphere", "radius": 2, "name": "a"}])");
}

TEST_CASE("text: materials have the names they were given, and equal ones are one", "[frontend][text]") {
  CHECK(scene_of("let red = diffuse(color = 0.5)\ndef ball(i) = sphere(i).material(diffuse(color = 0.1))\n"
                 "object ball(1).material(red)\nobject ball(2)") ==
        R"("materials": {"red": {"type": "diffuse", "color": 0.5}, "material": {"type": "diffuse", "color": 0.1}}, "objects": [ {"type": "union", "of": [{"type": "sphere", "radius": 1, "material": "material"}], "material": "red"}, {"type": "sphere", "radius": 2, "material": "material"} ])");
}

TEST_CASE("text: parameters decide loops and conditions", "[frontend][text]") {
  const std::string text = "param n = 2\nobject [for i in 0..n: sphere(i + 1)]";
  CHECK(scene_of(text, {{"n", 1}}) ==
        R"("params": {"n": 1}, "objects": [{"type": "union", "of": [{"type": "sphere", "radius": 1}]}])");
  CHECK(scene_of(text).find("\"radius\": 2") != std::string::npos);
}

// As a tree the scene would have 2^40 leaves.
TEST_CASE("text: doublings by functions are as many nodes", "[frontend][text]") {
  std::string text = "def d(part) = part + part.translate([1, 0, 0])\nobject ";
  for (int i = 0; i < 40; ++i) text += "d(";
  text += "sphere(1)" + std::string(40, ')');
  CHECK(scene_of(text).size() < 8000);
}

// A loop makes a chain deeper than the scene reader can recurse.
TEST_CASE("text: deep chains of nodes are named on the way", "[frontend][text]") {
  Source source("a.fathom", "fathom 1\nobject fold part = sphere(1) for i in 0..20000: part.onion(1/(i + 2))");
  Diagnostics diagnostics;
  CHECK(compile(source, diagnostics, {}).has_value());
}

TEST_CASE("text: chains of names are as long as they like", "[frontend][text]") {
  std::string text;
  for (int i = 0; i < 20000; ++i) text += fmt::format("let a{} = a{}\n", i, i + 1);
  CHECK(radius("a0", text + "let a20000 = 7") == "7");
}

}  // namespace

}  // namespace fathom::text_evaluate_test
