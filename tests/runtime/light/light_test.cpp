// The scene's lights together: samples, their densities, and the densities of hits. Single shapes:
// light_shapes_test.cpp. The environment: environment_test.cpp.
#include "runtime/light/light.h"

#include <fmt/format.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "runtime/base/color.h"
#include "runtime/sampling/sampler.h"
#include "tests/runtime/scenes.h"
#include "tests/support/catch.h"
#include "tests/support/scaled_cases.h"

namespace fathom::runtime::light_test {
namespace {

compiler::CompiledScene scene_with(const std::string& settings, const std::string& objects) {
  return scene_of(R"("materials": {"glow": {"type": "emissive", "emission": [2, 2, 2]},
      "warm": {"type": "emissive", "emission": [3, 2, 1]}})" +
                  settings + R"(, "objects": [)" + objects + "]");
}

const std::string kFloor = R"({"type": "plane", "normal": [0, 1, 0], "offset": -5})";
const std::string kRoom = R"(
    {"name": "ball", "type": "sphere", "radius": 0.5, "translate": [1, 2, 0], "material": "glow"},
    {"name": "panel", "type": "quad", "a": [-3, 4, -1], "b": [-2, 4, -1], "c": [-2, 4, 1], "d": [-3, 4, 1],
     "thickness": 0.01, "material": "warm"},
    {"name": "tube", "type": "capsule", "radius": 0.1, "half_height": 1, "translate": [0, 1, 3], "material": "glow"},
    {"name": "block", "type": "box", "half_size": [0.3, 0.3, 0.3], "translate": [3, 0, -2], "material": "warm"},
    {"name": "can", "type": "cylinder", "radius": 0.4, "half_height": 0.2, "translate": [-1, 0, -3], "material": "glow"},)" +
                          kFloor;

LightSample sample_one(const Lights& lights, const LightSampleContext& query, float choice, glm::vec2 u) {
  LightSample sample;
  const bool active = true;
  lights.sample({{&query, 1}, {&choice, 1}, {&u.x, 1}, {&u.y, 1}, {&active, 1}}, {&sample, 1});
  return sample;
}

LightSample sample(const Lights& lights, const LightSampleContext& query, std::uint32_t i) {
  Sampler sampler(4, i, 0, 0);
  const float choice = sampler.next();
  return sample_one(lights, query, choice, sampler.next2());
}

// Radiance of a ray that leaves the scene, and the density of its direction in light sampling.
struct Background {
  glm::vec3 radiance;
  float pdf;
};
Background background(const Lights& lights, const LightSampleContext& query, glm::vec3 direction) {
  DirectionRows rows;
  rows.set_direction(0, direction);
  lights.look_up_background(1, rows);
  return {rows.radiance(0), lights.pdf_of_background(query, direction, rows.density(0))};
}

const LightSampleContext kQueries[] = {{{0, -4.9, 0}, {0, 1, 0}},
                                       {{0.5, 0.2, 0.4}, {0.6f, 0.8f, 0}},
                                       {{-2, 3, 2}, {0, 0, 1}, true},
                                       {{20, 3, 30}, {-0.6f, 0, -0.8f}}};

// Irradiance by sampling, as luminance, with its standard error. Ignores shadows.
struct Mean {
  double value, error;
};
Mean irradiance(const Lights& lights, const LightSampleContext& query, int n) {
  double sum = 0, squares = 0;
  for (int i = 0; i < n; ++i) {
    const LightSample s = sample(lights, query, static_cast<std::uint32_t>(i));
    if (!(s.pdf > 0)) continue;
    const double value =
        static_cast<double>(std::max(0.0f, glm::dot(s.wi, query.normal)) * luminance(s.radiance) / s.pdf);
    sum += value;
    squares += value * value;
  }
  const double mean = sum / n;
  return {mean, std::sqrt(std::max(0.0, squares / n - mean * mean) / n) + 1e-6 * mean};
}

TEST_CASE("lights: a sample's density is that of the hit or of the background", "[light]") {
  const compiler::CompiledScene scene =
      scene_with(R"(, "background": {"type": "sky", "elevation": 40, "strength": 0.3},
                    "lights": {"sun": {"type": "directional", "direction": [1, -2, 0], "angle": 2}})",
                 kRoom);
  REQUIRE(scene.area_lights.size() == 5);
  const Lights lights(scene);
  for (const LightSampleContext& query : kQueries) {
    int near = 0, beyond = 0;
    double worst = 0;
    for (std::uint32_t i = 0; i < 2000; ++i) {
      const LightSample s = sample(lights, query, i);
      if (!(s.pdf > 0)) continue;
      CHECK(glm::length(s.wi) == Approx(1).epsilon(1e-5));
      float pdf = 0;
      if (std::isinf(s.distance)) {
        ++beyond;
        pdf = background(lights, query, s.wi).pdf;
        CHECK(s.radiance == background(lights, query, s.wi).radiance);
      } else {
        ++near;
        const glm::dvec3 hit = query.position + s.distance * glm::dvec3(s.wi);
        pdf = lights.pdf_of_hit(query, s.surface, hit);
        // wi is in float: at the very edge of a face the hit can lie on the next face.
        if (pdf == 0 || s.light_cosine < 0.01f) continue;
        CHECK(s.radiance == glm::vec3(scene.materials[s.material].emission));
        CHECK(scene.surfaces[s.surface].material == s.material);
      }
      worst = std::max(worst, std::abs(static_cast<double>(pdf / s.pdf) - 1));
    }
    CAPTURE(query.position.x, near, beyond, worst);
    // The lights choose area lights and what lies beyond the scene at least one time in four each, but the even part
    // of the sky is no sample.
    CHECK(near + beyond > 1000);
    CHECK(near > 300);
    CHECK(beyond > 100);
    CHECK(worst < 2e-3);
  }
}

TEST_CASE("lights: P3, the irradiance of a ball", "[light]") {
  const compiler::CompiledScene scene =
      scene_with("", R"({"type": "sphere", "radius": 0.5, "translate": [0, 3, 1], "material": "glow"},)" + kFloor);
  const Lights lights(scene);
  const LightSampleContext query{{0.5, 0, 0}, {0, 1, 0}};
  const double d2 = 0.25 + 9 + 1, truth = M_PI * 2 * 0.25 / d2 * (3 / std::sqrt(d2));
  const Mean e = irradiance(lights, query, 20000);
  CHECK(std::abs(e.value - truth) < 4 * e.error);
  CHECK(e.error < 1e-3 * truth);
}

TEST_CASE("lights: many lamps give the sum of each", "[light]") {
  std::string balls;
  for (int i = 0; i < 100; ++i) {
    balls += fmt::format(R"({{"type": "sphere", "radius": 0.1, "translate": [{}, {}, {}], "material": "glow"}},)",
                         i % 10 - 4.5, 2 + i % 3, i / 10 - 4.5);
  }
  const compiler::CompiledScene scene = scene_with("", balls + kFloor);
  REQUIRE(scene.area_lights.size() == 100);
  const Lights lights(scene);
  for (const glm::dvec3 place : {glm::dvec3(0, 0, 0), glm::dvec3(4.4, 1.5, 4.3)}) {
    double truth = 0;
    for (const compiler::AreaLight& area_light : scene.area_lights) {
      const glm::dvec3 way = area_light.translation - place;
      truth += M_PI * 2 * 0.01 / glm::dot(way, way) * (way.y / glm::length(way));
    }
    const Mean e = irradiance(lights, {place, {0, 1, 0}}, 20000);
    CAPTURE(e.value, truth);
    CHECK(std::abs(e.value - truth) < 4 * e.error);
    CHECK(e.error < 0.01 * truth);
  }
}

TEST_CASE("lights: point, spot and directional lights are exact", "[light]") {
  const LightSampleContext below{{0, 0, 0}, {0, 1, 0}};
  const auto only = [&](const std::string& light, const LightSampleContext& query) {
    const compiler::CompiledScene scene = scene_with(R"(, "lights": {"it": )" + light + "}", kFloor);
    return sample(Lights(scene), query, 1);
  };
  const LightSample point = only(R"({"type": "point", "position": [0, 2, 0], "intensity": [4, 8, 12]})", below);
  CHECK((point.delta && point.pdf == 1 && point.distance == Approx(2) && point.material == kNoMaterial));
  CHECK(glm::length(point.radiance - glm::vec3(1, 2, 3)) < 1e-6f);
  CHECK(glm::length(point.wi - glm::vec3(0, 1, 0)) < 1e-6f);
  CHECK(only(R"({"type": "point", "position": [0, -2, 0]})", below).pdf == 0);  // the light is behind the surface

  const std::string spot = R"({"type": "spot", "position": [0, 2, 0], "target": [0, 0, 0], "intensity": [4, 4, 4],
      "angle": 40, "blend": 0.5})";
  const auto at_degrees = [&](double degrees) {
    return only(spot, {{2 * std::tan(degrees * M_PI / 180), 0, 0}, {0, 1, 0}}).radiance.x *
           static_cast<float>(1 / std::pow(std::cos(degrees * M_PI / 180), 2));
  };
  CHECK(at_degrees(0) == Approx(1));
  CHECK(at_degrees(19) == Approx(1).epsilon(1e-5));
  CHECK(at_degrees(30) > 0.2);
  CHECK(at_degrees(30) < 0.8);
  CHECK(at_degrees(41) == 0);

  const LightSample sun = only(R"({"type": "directional", "toward": [0, 1, 1], "irradiance": [3, 3, 3]})", below);
  CHECK((sun.delta && sun.pdf == 1 && std::isinf(sun.distance) && sun.radiance == glm::vec3(3)));
  CHECK(glm::length(sun.wi - glm::normalize(glm::vec3(0, 1, 1))) < 1e-6f);
}

TEST_CASE("lights: lights of all kinds together give the sum of each", "[light]") {
  const compiler::CompiledScene scene =
      scene_with(R"(, "lights": {
      "a": {"type": "point", "position": [1, 4, 0], "intensity": [5, 5, 5]},
      "b": {"type": "directional", "irradiance": [0.5, 0.5, 0.5]},
      "c": {"type": "directional", "toward": [1, 1, 0], "irradiance": [1, 1, 1], "angle": 3}})",
                 R"({"type": "sphere", "radius": 0.5, "translate": [-2, 3, 1], "material": "glow"},)" + kFloor);
  const Lights lights(scene);
  const double ball = M_PI * 2 * 0.25 / 14 * (3 / std::sqrt(14.0)), point = 5.0 / 17 * (4 / std::sqrt(17.0));
  const double truth = ball + point + 0.5 + std::sqrt(0.5);
  const Mean e = irradiance(lights, {{0, 0, 0}, {0, 1, 0}}, test::scaled_cases(100000));
  CAPTURE(e.value, truth, e.error);
  CHECK(std::abs(e.value - truth) < 4 * e.error);
}

TEST_CASE("lights: what cannot be sampled has no density", "[light]") {
  // One object with one surface: a whole ball, and a ball that is cut.
  const compiler::CompiledScene scene =
      scene_with("", R"({"name": "lamps", "type": "union", "material": "glow", "of": [
      {"type": "sphere", "radius": 1},
      {"type": "subtraction", "of": [{"type": "sphere", "radius": 1, "translate": [4, 0, 0]},
                                     {"type": "box", "half_size": [1, 1, 1], "translate": [4, 1, 0]}]}]},)" +
                         kFloor);
  REQUIRE(scene.area_lights.size() == 1);
  const Lights lights(scene);
  const LightSampleContext query{{2, -4, 0}, {0, 1, 0}};
  CHECK(lights.pdf_of_hit(query, scene.area_lights[0].surface, {0, -1, 0}) > 0);
  CHECK(lights.pdf_of_hit(query, scene.area_lights[0].surface, {4, -1, 0}) == 0);
  CHECK(lights.pdf_of_hit(query, scene.area_lights[0].surface + 1, {0, -1, 0}) == 0);
  CHECK(background(lights, query, {0, 1, 0}).pdf == 0);
  // The query is inside the ball.
  CHECK(lights.pdf_of_hit({{0, 0, 0}, {0, 1, 0}}, scene.area_lights[0].surface, {0, -1, 0}) == 0);
}

TEST_CASE("lights: faces that coincide are lit once", "[light]") {
  // Two boxes make a cross. The middle of the cross's lower face belongs to both.
  const compiler::CompiledScene scene = scene_with("", R"(
      {"type": "box", "half_size": [2, 0.1, 0.5], "translate": [0, 3, 0], "material": "glow"},
      {"type": "box", "half_size": [0.5, 0.1, 2], "translate": [0, 3, 0], "material": "glow"},)" +
                                                           kFloor);
  REQUIRE(scene.area_lights.size() == 2);
  const Lights lights(scene);
  const LightSampleContext query{{0.1, 0, 0.2}, {0, 1, 0}};
  // Lambert's formula, summed over small areas of the cross. The boxes' sides face away from the point below, or
  // nearly.
  double truth = 0;
  constexpr int kSteps = 800;
  for (int i = 0; i < kSteps; ++i) {
    for (int j = 0; j < kSteps; ++j) {
      const double x = -2 + 4 * (i + 0.5) / kSteps, z = -2 + 4 * (j + 0.5) / kSteps;
      if (std::abs(x) > 0.5 && std::abs(z) > 0.5) continue;
      const double y = 2.9, dx = x - 0.1, dz = z - 0.2, d2 = dx * dx + y * y + dz * dz;
      truth += 2 * y * y / (d2 * d2) * 16 / (kSteps * kSteps);
    }
  }
  const Mean e = irradiance(lights, query, test::scaled_cases(60000));
  CAPTURE(e.value, truth, e.error);
  CHECK(std::abs(e.value - truth) < 4 * e.error + 1e-3 * truth);
  // The error is small enough to detect the middle being counted twice.
  CHECK(e.error < 0.02 * truth);
}

TEST_CASE("lights: a scene without any is empty", "[light]") {
  CHECK(Lights(scene_with("", kFloor)).empty());
  CHECK(sample_one(Lights(scene_with("", kFloor)), kQueries[0], 0.5f, {0.5f, 0.5f}).pdf == 0);
  CHECK(Lights(scene_with(R"(, "background": [1, 1, 1])", kFloor)).empty());  // only hits find a uniform background
  CHECK_FALSE(Lights(scene_with(R"(, "background": {"type": "sky"})", kFloor)).empty());
  CHECK_FALSE(Lights(scene_with("", kRoom)).empty());
  CHECK_FALSE(Lights(scene_with(R"(, "lights": {"p": {"type": "point"}})", kFloor)).empty());
  const Lights black(scene_with(R"(, "lights": {"p": {"type": "point", "intensity": [0, 0, 0]}})", kFloor));
  CHECK(sample_one(black, kQueries[0], 0.5f, {0.5f, 0.5f}).pdf == 0);
}

}  // namespace
}  // namespace fathom::runtime::light_test
