// The adversarial catalogue, rows F1, F2 and F8 to F12: distances of solids whose formulas are often printed wrong,
// and of parameters for which formulas divide by zero. All primitives against brute force, and all Lipschitz
// constants against random graphs: tests/compiler/shapes/shapes_test.cpp. docs/explanation/accuracy.md lists all
// rows.
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "tests/catalogue/naive.h"
#include "tests/catalogue/solids.h"
#include "tests/support/catch.h"
#include "tests/support/compiled.h"
#include "tests/support/plain_lowering.h"

namespace fathom::catalogue::fields_test {
namespace {

using test::compiled_objects;

constexpr double kUnit = 0x1p-24;  // rounding error of a float in [1,2)

double scale_of(glm::dvec3 p) { return std::max({1.0, std::abs(p.x), std::abs(p.y), std::abs(p.z)}); }

glm::dvec3 random_point(Random& random) {
  const double half = random.uniform(0, 1) < 0.8 ? 2 : 16;
  glm::dvec3 p = to_float({random.uniform(-half, half), random.uniform(-half, half), random.uniform(-half, half)});
  if (random.uniform(0, 1) < 0.1) p.x = p.z = 0;
  if (random.uniform(0, 1) < 0.1) p.y = 0;
  return p;
}

struct Value {
  double distance;
  glm::dvec3 gradient;
};

Value float_value(const compiler::CompiledScene& scene, glm::dvec3 p, vm::Workspace& workspace) {
  const float x = static_cast<float>(p.x), y = static_cast<float>(p.y), z = static_cast<float>(p.z);
  float d, gx, gy, gz;
  std::uint32_t surface;
  vm::evaluate_surface(scene.surface, {&x, &y, &z}, 1, {&d, &gx, &gy, &gz, &surface}, workspace);
  return {d, {gx, gy, gz}};
}

// Compares distances with the truth in double and in float, at 10000 points inside and around the solid. Gradients
// must have length at most 1 and never be NaN.
void expect_distance(const std::string& node, const Distance& truth) {
  const auto scene = compiled_objects(node);
  vm::Workspace workspace;
  Random random(1);
  double wide = 0, narrow = 0, longest = 0;
  for (int i = 0; i < 10000; ++i) {
    const glm::dvec3 p = random_point(random);
    const long double expected = truth(Vec3(p));
    const vm::SurfaceValue exact = vm::evaluate_surface(scene.surface, p, workspace);
    const Value coarse = float_value(scene, p, workspace);
    wide = std::max(wide, std::abs(static_cast<double>(exact.distance - expected)) / scale_of(p));
    narrow = std::max(narrow, std::abs(static_cast<double>(coarse.distance - expected)) / scale_of(p) / kUnit);
    for (const double length : {glm::length(exact.gradient), glm::length(coarse.gradient)}) {
      longest = length <= longest ? longest : length;  // keeps a NaN
    }
    if (!std::isfinite(exact.distance) || !std::isfinite(coarse.distance)) FAIL("no number at " << p.x << ' ' << p.y);
  }
  INFO(node);
  CHECK(wide <= 1e-14);
  CHECK(narrow <= 8);
  CHECK(longest <= 1 + 1e-6);
}

// Round box with the misprint of the renderer's first paper: p.y instead of q.y.
double misprinted_round_box(glm::dvec3 p, glm::dvec3 half, double radius) {
  const glm::dvec3 q = glm::abs(p) - half;
  return glm::length(glm::max(q, 0.0)) + std::min(std::max(q.x, std::max(p.y, q.z)), 0.0) - radius;
}

// Max of |change of the field| / distance over 20000 pairs of points that are 1e-4 to 1 apart.
template <class Field>
double steepest(const Field& field) {
  Random random(2);
  double steepest = 0;
  for (int i = 0; i < 20000; ++i) {
    const glm::dvec3 p = random_point(random), q = p + random.direction() * std::pow(10.0, random.uniform(-4, 0));
    steepest = std::max(steepest, (std::abs(field(p) - field(q)) - 1e-12) / glm::length(p - q));
  }
  return steepest;
}

std::string number(double x) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", x);
  return text;
}

}  // namespace

TEST_CASE("F1: solids whose usual formulas are misprinted", "[catalogue]") {
  expect_distance(R"({"type": "round_box", "half_size": [1, 0.75, 0.5], "radius": 0.25})",
                  [](const Vec3& p) { return box_distance(p, Vec3(0.75, 0.5, 0.25)) - 0.25L; });
  expect_distance(R"({"type": "cylinder", "radius": 0.5, "half_height": 1.25})",
                  [](const Vec3& p) { return rectangle_distance(half_plane(p), Vec2(0.5, 1.25)); });
  expect_distance(R"({"type": "rounded_cylinder", "radius": 0.75, "half_height": 1, "rounding": 0.25})",
                  [](const Vec3& p) { return rectangle_distance(half_plane(p), Vec2(0.5, 0.75)) - 0.25L; });
  expect_distance(R"({"type": "cone", "bottom_radius": 1, "top_radius": 0.5, "half_height": 0.75})",
                  [](const Vec3& p) { return cone_distance(p, 1, 0.5, 0.75); });
  expect_distance(R"({"type": "plane", "normal": [0, 2, 0], "offset": 0.25})",
                  [](const Vec3& p) { return p.y - 0.25L; });
  expect_distance(
      R"({"type": "triangle", "a": [0, 0, 0], "b": [1, 0.5, 0], "c": [0.25, 1, 0.5], "thickness": 0.125})",
      [](const Vec3& p) {
        return sheet_distance<3>(p, {Vec3(0), Vec3(1, 0.5, 0), Vec3(0.25, 1, 0.5)}) - 0.125L;
      });
  // The misprint shows below the box, where the field bulges.
  CHECK(misprinted_round_box({0, -1.3, 0}, {0.75, 0.5, 0.25}, 0.25) < 0.5);
  CHECK(box_distance(Vec3(0, -1.3L, 0), Vec3(0.75, 0.5, 0.25)) - 0.25L > 0.54L);
}

TEST_CASE("F2: no field changes faster than the compiler says", "[catalogue]") {
  const char* nodes[] = {
      R"({"type": "round_box", "half_size": [1, 0.75, 0.5], "radius": 0.25})",
      R"({"type": "plane", "normal": [0, 2, 0]})",
      R"({"type": "cone", "bottom_radius": 1, "top_radius": 0, "half_height": 0.75})",
      R"({"type": "torus", "major_radius": 0.5, "minor_radius": 1})",
      R"({"type": "round_cone", "bottom_radius": 1, "top_radius": 0.25, "height": 1})",
      R"({"type": "sphere", "radius": 1, "scale": [3, 1, 0.5]})",
      R"({"type": "smooth_union", "k": 0.5, "of": [{"type": "sphere", "radius": 1},
          {"type": "box", "half_size": [0.5, 1.5, 0.5]}]})",
      R"({"type": "twist", "turn": 90, "of": {"type": "box", "half_size": [0.5, 1, 0.25]}})",
      R"J({"type": "displacement", "formula": "0.05*sin(20*x)*sin(20*y)*sin(20*z)", "of": {"type": "sphere", "radius": 1}})J",
      R"({"type": "repetition", "period": [1, 1, 1], "jitter": [0.25, 0.25, 0.25], "of": {"type": "sphere", "radius": 0.25}})"};
  for (const char* node : nodes) {
    const auto scene = compiled_objects(node);
    vm::Workspace workspace;
    INFO(node << ", Lipschitz constant " << scene.lipschitz);
    CHECK(scene.certified);
    CHECK(steepest([&](glm::dvec3 p) { return vm::evaluate_distance(scene.distance, p, workspace); }) <=
          scene.lipschitz * (1 + 1e-6));
  }
  CHECK(steepest([](glm::dvec3 p) { return misprinted_round_box(p, {0.75, 0.5, 0.25}, 0.25); }) > 1.3);
  CHECK(steepest([](glm::dvec3 p) { return 2 * p.y; }) > 1.9);  // a plane with a normal of length 2
}

TEST_CASE("F8: a round cone whose one ball just holds the other", "[catalogue]") {
  const auto round_cone = [](double height) {
    return R"({"type": "round_cone", "bottom_radius": 1, "top_radius": 0.25, "height": )" + number(height) + "}";
  };
  const Distance ball = [](const Vec3& p) { return glm::length(p) - 1; };
  expect_distance(round_cone(0.75), ball);
  // The cone between the balls is 1e-8 wide. Its effect on distances in double is below the square of that width.
  expect_distance(round_cone(std::nextafter(0.75, 1)), ball);
  CHECK(codes_of(round_cone(std::nextafter(0.75, 0))) == "E0302");
  CHECK(codes_of(round_cone(0.5)) == "E0302");
}

TEST_CASE("F9: cones with a tip, without a taper, without a radius, without a height", "[catalogue]") {
  const auto cone = [](const char* bottom, const char* top, const char* half_height) {
    return std::string(R"({"type": "cone", "bottom_radius": )") + bottom + R"(, "top_radius": )" + top +
           R"(, "half_height": )" + half_height + "}";
  };
  expect_distance(cone("0", "1", "0.75"), [](const Vec3& p) { return cone_distance(p, 0, 1, 0.75); });
  expect_distance(cone("1", "0", "0.75"), [](const Vec3& p) { return cone_distance(p, 1, 0, 0.75); });
  expect_distance(cone("1", "1", "0.75"),
                  [](const Vec3& p) { return rectangle_distance(half_plane(p), Vec2(1, 0.75)); });
  CHECK(codes_of(cone("0", "0", "1")) == "E0302");
  CHECK(codes_of(cone("1", "0.5", "0")) == "E0301");
  CHECK(codes_of(cone("-1", "0.5", "1")) == "E0301");
}

TEST_CASE("F10: a ring thicker than it is wide", "[catalogue]") {
  const auto scene = compiled_objects(R"({"type": "torus", "major_radius": 0.5, "minor_radius": 1})");
  vm::Workspace workspace;
  Random random(3);
  double outside = 0, shortest = 0, depth = 0;
  for (int i = 0; i < 10000; ++i) {
    const glm::dvec3 p = random_point(random);
    const double truth = static_cast<double>(spindle_distance(Vec3(p), 0.5, 1));
    const double found = vm::evaluate_distance(scene.distance, p, workspace);
    if (truth > 0) outside = std::max(outside, std::abs(found - truth) / scale_of(p));
    if (truth <= 0) depth = std::max(depth, truth - found);  // deeper than the truth
    if (truth <= 0) shortest = std::max(shortest, found);    // positive although inside
    CHECK(std::isfinite(glm::length(float_value(scene, p, workspace).gradient)));
  }
  CHECK(outside <= 1e-14);
  CHECK(depth <= 1e-14);
  CHECK(shortest <= 1e-14);
  for (const double y : {-2.0, -std::sqrt(0.75), -0.5, 0.0, 0.25, std::sqrt(0.75), 3.0}) {  // on the axis
    const double length = glm::length(vm::evaluate_surface(scene.surface, {0, y, 0}, workspace).gradient);
    INFO(y);
    CHECK(length <= 1 + 1e-12);
    CHECK(glm::length(float_value(scene, {0, y, 0}, workspace).gradient) <= 1 + 1e-6);
  }
  CHECK(codes_of(R"({"type": "torus", "major_radius": 0, "minor_radius": 1})") == "E0301");
}

TEST_CASE("F11: triangles and quads without an area, slivers, and quads that are no quads", "[catalogue]") {
  const auto triangle = [](const char* corners) {
    return std::string(R"({"type": "triangle", "thickness": 0.125, )") + corners + "}";
  };
  const auto quad = [](const char* corners) {
    return std::string(R"({"type": "quad", "thickness": 0.125, )") + corners + "}";
  };
  CHECK(codes_of(triangle(R"("a": [1, 2, 3], "b": [1, 2, 3], "c": [0, 0, 1])")) == "E0302");
  CHECK(codes_of(triangle(R"("a": [0, 0, 0], "b": [1, 1, 1], "c": [3, 3, 3])")) == "E0302");
  CHECK(codes_of(quad(R"("a": [0, 0, 0], "b": [1, 0, 0], "c": [1, 0, 0], "d": [0, 1, 0])")) == "E0302");
  CHECK(codes_of(quad(R"("a": [0, 0, 0], "b": [1, 0, 0], "c": [1, 1, 0.5], "d": [0, 1, 0])")) == "E0302");
  CHECK(codes_of(quad(R"("a": [0, 0, 0], "b": [1, 0, 0], "c": [0.25, 0.25, 0], "d": [0, 1, 0])")) == "E0302");
  CHECK(codes_of(quad(R"("a": [0, 0, 0], "b": [1, 1, 0], "c": [1, 0, 0], "d": [0, 1, 0])")) == "E0302");
  expect_distance(triangle(R"("a": [0, 0, 0], "b": [1, 0, 0], "c": [0.5, 1e-6, 0])"), [](const Vec3& p) {
    return sheet_distance<3>(p, {Vec3(0), Vec3(1, 0, 0), Vec3(0.5L, 1e-6, 0)}) - 0.125L;
  });
  expect_distance(quad(R"("a": [0, 0, 0], "b": [1, 0, 0], "c": [1, 1, 0], "d": [0, 0.5, 0])"), [](const Vec3& p) {
    return sheet_distance<4>(p, {Vec3(0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 0.5, 0)}) - 0.125L;
  });
}

TEST_CASE("F12: normals of any length make the same plane, one of none makes none", "[catalogue]") {
  vm::Workspace workspace;
  for (const double length : {1e-200, 1e-30, 1.0, 1e30, 1e200}) {
    const vm::VerifiedProgram program =
        test::primitive_program(compiler::Kind::Plane, {0.6 * length, -0.8 * length, 0, 0.25});
    INFO(length);
    CHECK(std::abs(vm::evaluate_distance(program, glm::dvec3(1, 2, 3), workspace) - (0.6 - 1.6 - 0.25)) <= 1e-15);
  }
  const auto plane = [](const char* normal) {
    return std::string(R"({"type": "plane", "offset": 0.25, "normal": )") + normal + "}";
  };
  for (const char* normal : {"[0.6e-30, -0.8e-30, 0]", "[0.6e18, -0.8e18, 0]"}) {
    expect_distance(plane(normal), [](const Vec3& p) { return 0.6L * p.x - 0.8L * p.y - 0.25L; });
  }
  CHECK(codes_of(plane("[0, 0, 0]")) == "E0301");
  CHECK(codes_of(plane("[0, 1e30, 0]")) == "E0301");  // larger than any number that a scene may contain
}

}  // namespace fathom::catalogue::fields_test
