// Tests of the search for area lights: which nodes of a graph qualify, their positions and their sizes.
#include "compiler/analysis/area_lights.h"

#include <fmt/format.h>

#include <glm/geometric.hpp>
#include <string>

#include "tests/support/catch.h"
#include "tests/support/compiled.h"

namespace fathom::compiler::lamps_test {
namespace {

CompiledScene lit(const std::string& objects) {
  return test::compiled(R"({"version": 1, "materials": {"dull": {"type": "diffuse"},
      "glow": {"type": "emissive", "emission": [1, 2, 3]}, "dark": {"type": "emissive", "emission": [0, 0, 0]}},
      "objects": [)" + objects +
                        "]}");
}
std::size_t area_lights_in(const std::string& objects) { return lit(objects).area_lights.size(); }

glm::dvec3 place(const AreaLight& area_light, glm::dvec3 q) {
  return area_light.rotation * q + area_light.translation;
}

TEST_CASE("lamps: every shape, where its transforms put it", "[analysis][lamps]") {
  const CompiledScene scene = lit(R"(
      {"type": "sphere", "radius": 0.5, "scale": 2, "translate": [1, 2, 3], "material": "glow"},
      {"type": "box", "half_size": [1, 2, 3], "rotate": [0, 90, 0], "material": "glow"},
      {"type": "cylinder", "radius": 1, "half_height": 0.01, "material": "glow"},
      {"type": "capsule", "radius": 1, "half_height": 2, "material": "glow", "scale": 0.5},
      {"type": "sphere", "radius": 9, "translate": [0, -10, 0], "material": "dull"})");
  REQUIRE(scene.area_lights.size() == 4);
  const AreaLight &ball = scene.area_lights[0], &box = scene.area_lights[1], &disc = scene.area_lights[2],
                  &pill = scene.area_lights[3];
  CHECK(ball.shape == AreaLight::Shape::Sphere);
  CHECK(ball.radius == Approx(1));
  CHECK(glm::length(ball.translation - glm::dvec3(1, 2, 3)) < 1e-12);
  CHECK(scene.surfaces[ball.surface].material == ball.material);
  CHECK(scene.materials[ball.material].name == "glow");
  CHECK(box.shape == AreaLight::Shape::Box);
  // The rotation takes z to x: counter-clockwise about y.
  CHECK(glm::length(place(box, {0, 0, 3}) - glm::dvec3(3, 0, 0)) < 1e-12);
  CHECK(box.half_size == glm::dvec3(1, 2, 3));
  CHECK((disc.shape == AreaLight::Shape::Cylinder && disc.radius == 1 && disc.half_height == 0.01));
  CHECK((pill.shape == AreaLight::Shape::Capsule && pill.radius == 0.5 && pill.half_height == 1));
}

TEST_CASE("lamps: a quad stands in a plane of its own", "[analysis][lamps]") {
  const CompiledScene scene =
      lit(R"({"type": "quad", "a": [1, 5, 1], "b": [-1, 5, 1], "c": [-1, 5, -2], "d": [1, 5, -1],
      "thickness": 0.01, "material": "glow", "scale": 2, "rotate": [20, 30, 40], "translate": [0, 1, 0]})");
  REQUIRE(scene.area_lights.size() == 1);
  const AreaLight& quad = scene.area_lights[0];
  CHECK(quad.shape == AreaLight::Shape::Quad);
  CHECK(quad.radius == Approx(0.02));
  double area = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const glm::dvec2 p = quad.corners[i], q = quad.corners[(i + 1) % 4];
    area += 0.5 * (p.x * q.y - p.y * q.x);
  }
  CHECK(area == Approx(4 * 5));
  // The transform preserves lengths (up to its scale) and the distance from its fixed point.
  CHECK(glm::length(place(quad, {quad.corners[0], 0}) - glm::dvec3(0, 1, 0)) == Approx(2 * std::sqrt(27.0)));
  CHECK(std::abs(glm::determinant(quad.rotation) - 1) < 1e-12);
}

TEST_CASE("lamps: what is altered, cut, blended or dark is none", "[analysis][lamps]") {
  const std::string ball = R"({"type": "sphere", "radius": 1, "material": "glow"})";
  CHECK(area_lights_in(ball) == 1);
  CHECK(area_lights_in(R"({"type": "sphere", "radius": 1, "material": "dark"})") == 0);
  CHECK(area_lights_in(R"({"type": "sphere", "radius": 1, "scale": [1, 2, 1], "material": "glow"})") == 0);
  CHECK(area_lights_in(R"({"type": "torus", "major_radius": 1, "minor_radius": 0.2, "material": "glow"})") == 0);
  for (const char* altered :
       {R"({"type": "round", "radius": 0.1, "of": )", R"({"type": "onion", "thickness": 0.1, "of": )",
        R"({"type": "twist", "turn": 10, "of": )",
        R"({"type": "repetition", "period": [3, 0, 0], "count": [2, 1, 1], "of": )"}) {
    CHECK(area_lights_in(altered + ball + "}") == 0);
  }
  for (const char* combined : {R"({"type": "subtraction", "of": [)", R"({"type": "intersection", "of": [)",
                               R"({"type": "smooth_union", "k": 0.1, "of": [)", R"({"type": "xor", "of": [)"}) {
    CHECK(area_lights_in(combined + ball + R"(, {"type": "box", "half_size": [1, 1, 0.5]}]})") == 0);
  }
  CHECK(area_lights_in(R"({"type": "union", "of": [)" + ball + R"(, {"type": "box", "half_size": [1, 1, 0.5]}]})") ==
        1);
}

TEST_CASE("lamps: paint further in wins, and each place is one lamp", "[analysis][lamps]") {
  CHECK(area_lights_in(R"({"type": "union", "material": "glow", "of": [
      {"type": "sphere", "radius": 1}, {"type": "sphere", "radius": 1, "translate": [3, 0, 0], "material": "dull"},
      {"type": "sphere", "radius": 1, "translate": [6, 0, 0]}]})") == 2);
  const std::string twice = R"({"type": "sphere", "radius": 1, "material": "glow"})";
  CHECK(area_lights_in(twice + "," + twice) == 1);
  // The level pass divides steep operands of a union by their Lipschitz constants. The pass must not hide an area
  // light.
  CHECK(area_lights_in(
            twice + R"(, {"type": "shear", "shift": [2, 0], "of": {"type": "box", "half_size": [1, 1, 1]}})") == 1);
}

TEST_CASE("lamps: what light may pass is none", "[analysis][lamps]") {
  const auto count = [](const std::string& material) {
    const Source source("scene.json",
                        R"({"version": 1, "materials": {"m": {"type": "principled", "emission": [1, 1, 1], )" +
                            material + R"(}}, "objects": [{"type": "sphere", "radius": 1, "material": "m"}]})");
    Diagnostics diagnostics;
    const auto scene = compile(source, diagnostics);
    REQUIRE(scene);
    return scene->area_lights.size();
  };
  CHECK(count(R"("roughness": 0.5)") == 1);
  CHECK(count(R"("transmission": 1)") == 0);
  CHECK(count(R"("opacity": 0.5)") == 0);
  CHECK(count(R"("opacity": "0.5 + x")") == 0);
}

TEST_CASE("lamps: far from zero they stand in the programs' coordinates", "[analysis][lamps]") {
  const CompiledScene scene = lit(R"({"type": "sphere", "radius": 1, "translate": [1e5, 0, 0], "material": "glow"},
      {"type": "quad", "a": [99999, 3, 0], "b": [100001, 3, 0], "c": [100001, 3, 2], "d": [99999, 3, 2],
       "thickness": 0.1, "material": "glow"})");
  REQUIRE(scene.area_lights.size() == 2);
  REQUIRE(scene.origin != glm::dvec3(0));
  CHECK(glm::length(scene.area_lights[0].translation + scene.origin - glm::dvec3(1e5, 0, 0)) < 1e-9);
  CHECK(glm::length(scene.area_lights[1].translation + scene.origin - glm::dvec3(1e5, 3, 1)) < 1e-9);
}

TEST_CASE("lamps: a graph that stands for very many ends at the limit", "[analysis][lamps]") {
  std::string nodes = R"("n0": {"type": "sphere", "radius": 0.1})";
  for (int i = 1; i <= 17; ++i) {
    nodes += fmt::format(
        R"(, "n{0}": {{"type": "union", "of": [{{"use": "n{1}"}}, {{"use": "n{1}", "translate": [{2}, 0, 0]}}]}})", i,
        i - 1, 1 << (i - 1));
  }
  CompileOptions options;
  std::size_t found = 0;
  options.on_pass = [&](std::string_view pass, const Scene& scene) {
    if (pass != "graph") return;
    Material glow;
    glow.type = Material::Type::Emissive;
    glow.emission_luminance = 1;
    const Surface surface{"all", 0};
    found = find_area_lights(scene, std::span(&surface, 1), std::span(&glow, 1)).size();
  };
  const Source source("scene.json", R"({"version": 1, "nodes": {)" + nodes + R"(}, "objects": [{"use": "n17"}]})");
  Diagnostics diagnostics;
  compile(source, diagnostics, options);  // the scene needs too many instructions
  CHECK(found == kMaxAreaLights);
}

}  // namespace
}  // namespace fathom::compiler::lamps_test
