// Tests of the exactness report and the lints, in addition to their golden files.
#include "compiler/analysis/report.h"

#include <cmath>

#include "compiler/compile.h"
#include "tests/support/catch.h"

namespace fathom::report_test {

namespace {

using namespace fathom::compiler;

struct Compiled {
  Scene graph;
  std::vector<Surface> surfaces;
  Diagnostics diagnostics;
};

Compiled compiled(const std::string& objects, bool lint = false) {
  Compiled result;
  CompileOptions options;
  options.lint = lint;
  options.on_pass = [&](std::string_view pass, const Scene& scene) {
    if (pass == "graph") result.graph = scene;
  };
  const Source source("scene.json", R"({"version": 1, "objects": [)" + objects + "]}");
  const auto scene = compile(source, result.diagnostics, options);
  INFO(result.diagnostics.print(source, ErrorFormat::Text));
  REQUIRE(scene);
  result.surfaces = scene->surfaces;
  return result;
}

Report report_of(const std::string& objects) {
  const Compiled scene = compiled(objects);
  return make_report(scene.graph, scene.surfaces);
}

}  // namespace

TEST_CASE("the report has a row for each object, by its own field", "[analysis][report]") {
  const Report report = report_of(R"({"type": "sphere", "radius": 1},
    {"name": "both", "type": "intersection", "of": [
      {"type": "sphere", "radius": 1}, {"type": "box", "half_size": [1, 1, 1]}]},
    {"name": "rope", "type": "twist", "turn": 90, "translate": [9, 0, 0], "of":
      {"type": "box", "half_size": [1, 3, 1]}})");
  REQUIRE(report.objects.size() == 3);
  CHECK(report.certified);
  CHECK(report.estimates.empty());
  CHECK(report.objects[0].name == "sphere");
  CHECK(class_of(report.objects[0].facts, report.in_cells) == "exact");
  CHECK_FALSE(report.objects[0].costliest);
  CHECK(class_of(report.objects[1].facts, report.in_cells) == "bound");
  // Lipschitz constant of the twist: (kR + sqrt(k^2 R^2 + 4)) / 2 with k = pi/2; R is a thousandth more than sqrt 2.
  const double radius = 1.001 * std::sqrt(2.0), kr = 1.5707963267948966 * radius,
               expected = (kr + std::sqrt(kr * kr + 4)) / 2;
  CHECK(report.objects[2].lipschitz == Approx(expected));
  REQUIRE(report.objects[2].costliest);
  CHECK(report.objects[2].costliest->place.type == "twist");
  CHECK(report.objects[2].costliest->times == Approx(expected));
  CHECK(report.objects[2].facts.box.lo.x == Approx(9 - radius));
}

TEST_CASE("a steep part within an object counts, though it is levelled", "[analysis][report]") {
  const Report report = report_of(R"({"type": "union", "of": [{"type": "sphere", "radius": 1},
    {"name": "rope", "type": "twist", "turn": 90, "of": {"type": "box", "half_size": [1, 3, 1]}}]})");
  REQUIRE(report.objects.size() == 1);
  CHECK(report.objects[0].facts.lipschitz == 1);
  CHECK(report.objects[0].lipschitz > 2);
  REQUIRE(report.objects[0].costliest);
  CHECK(report.objects[0].costliest->place.name == "rope");
}

TEST_CASE("costs along a path multiply to the whole", "[analysis][report]") {
  const Report report = report_of(R"_({"type": "twist", "turn": 10, "of": {"type": "displacement",
    "formula": "sin(20*x)/5", "of": {"type": "box", "half_size": [1, 1, 1]}}})_");
  REQUIRE(report.objects[0].costliest);
  CHECK(report.objects[0].costliest->place.type == "displacement");
  CHECK(report.objects[0].costliest->times < report.objects[0].lipschitz);
}

TEST_CASE("the nodes that are estimates are named, not what is made of them", "[analysis][report]") {
  const Report report = report_of(R"_({"type": "round", "radius": 0.1, "of": {"name": "bulb", "type": "mandelbulb"}},
    {"type": "sphere", "radius": 1}, {"name": "jump", "type": "expression", "formula": "y - floor(x)"})_");
  CHECK_FALSE(report.certified);
  REQUIRE(report.estimates.size() == 2);
  CHECK(report.estimates[0].name == "bulb");
  CHECK(report.estimates[1].name == "jump");
  CHECK(class_of(report.objects[0].facts, report.in_cells) == "estimate");
  CHECK(class_of(report.objects[1].facts, report.in_cells) == "exact");
}

TEST_CASE("one union as the only object is one object", "[analysis][report]") {
  const char* const balls = R"({"version": 1, "materials": {"a": {"type": "diffuse"}},
    "objects": [{"name": "pair", "type": "union", "of": [
      {"type": "sphere", "radius": 1, "material": "a"},
      {"type": "sphere", "radius": 1, "translate": [3, 0, 0], "material": "a"}]}]})";
  CompileOptions options;
  Scene graph;
  options.on_pass = [&](std::string_view pass, const Scene& scene) {
    if (pass == "graph") graph = scene;
  };
  Diagnostics diagnostics;
  const auto scene = compile(Source("scene.json", balls), diagnostics, options);
  REQUIRE(scene);
  const Report report = make_report(graph, scene->surfaces);
  REQUIRE(report.objects.size() == 1);
  CHECK(report.objects[0].name == "pair");
}

// Regression: a lint said that an area light inside a glass ball emits no light and that a camera under water must
// move.
TEST_CASE("what is within glass shows", "[analysis][report]") {
  const std::string outer = R"("camera": {"position": [1.5, 0, 0]}, "objects": [
      {"type": "sphere", "radius": 2, "material": "glass"}, {"type": "sphere", "radius": 1)";
  const std::pair<std::string, std::string> cases[] = {
      {"", ""}, {"", R"(, "material": "glass")"}, {R"(, "lamp": {"type": "emissive"})", R"(, "material": "lamp")"}};
  for (const auto& [material, inner] : cases) {
    const Source source("scene.json", R"({"version": 1, "background": [1, 1, 1],
      "materials": {"glass": {"type": "transparent"})" + material +
                                          "}, " + outer + inner + "}]}");
    Diagnostics diagnostics;
    CompileOptions options;
    options.lint = true;
    compile(source, diagnostics, options);
    CHECK(diagnostics.all().empty());
  }
}

TEST_CASE("lints are for check, and a formula without a bound is for everyone", "[analysis][report]") {
  const std::string hidden = R"({"type": "sphere", "radius": 2}, {"type": "sphere", "radius": 1})";
  CHECK(compiled(hidden).diagnostics.all().empty());
  REQUIRE(compiled(hidden, true).diagnostics.all().size() == 2);
  CHECK(compiled(hidden, true).diagnostics.all()[0].code == "W0501");
  CHECK(compiled(hidden, true).diagnostics.all()[1].code == "W0515");
  const std::string jump = R"_({"type": "expression", "formula": "y - floor(4000*x)"})_";
  CHECK(compiled(jump).diagnostics.all().back().code == "W0509");
}

}  // namespace fathom::report_test
