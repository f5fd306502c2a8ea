// The compiler gives scenes far from zero a local origin. The compiled scenes keep their meaning and are as exact as
// near zero.
#include "compiler/analysis/origin.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <string>

#include "compiler/graph/rewrite.h"
#include "compiler/lower/lower.h"
#include "compiler/passes/passes.h"
#include "compiler/shapes/bounds.h"
#include "compiler/shapes/print_graph.h"
#include "tests/support/catch.h"
#include "tests/support/compiled.h"
#include "tests/support/judge/judge.h"
#include "tests/support/plain_lowering.h"
#include "tests/support/random/random_scene.h"
#include "tests/support/scaled_cases.h"
#include "vm/interpret/evaluate.h"

namespace fathom::test::origin_test {
namespace {

using compiler::Kind;
using compiler::Scene;
using glm::dvec3;
using test::compiled;
using test::compiled_objects;

Scene scene_of(std::uint64_t seed) {
  Random random(seed);
  GraphOptions options;
  options.depth = 2 + static_cast<int>(seed % 4);
  return random_scene(random, options);
}

// Coordinates of few digits, so that sums with the coordinates of points are exact.
dvec3 random_origin(Random& random, double most) {
  dvec3 origin;
  for (int i = 0; i < 3; ++i) origin[i] = std::round(random.uniform(-most, most) * 8) / 8;
  return origin;
}

std::string print(const Scene& scene) { return compiler::print_graph(scene, compiler::Source{}); }

Scene optimised(Scene scene) {
  for (const compiler::Pass& pass : compiler::passes()) scene = pass.run(scene);
  return scene;
}

// A ball and a box at (x, 3, 0), followed by the objects in `more`.
std::string at(const std::string& x, const std::string& more = "") {
  return R"({"type": "union", "translate": [)" + x + R"(, 3, 0], "of": [{"type": "sphere", "radius": 1},
      {"type": "box", "half_size": [0.5, 0.25, 1], "translate": [1.25, 0, 0.5]}]})" +
         more;
}

const std::string kFloor = R"(, {"type": "plane", "normal": [0, 1, 0]})";

dvec3 origin_of(const std::string& objects, const std::string& camera = "[0, 0, 5], \"target\": [0, 0, 0]") {
  return compiled(R"({"version": 1, "camera": {"position": )" + camera + R"(}, "objects": [)" + objects + "]}")
      .origin;
}

}  // namespace

TEST_CASE("origin: a moved scene is at p what the scene is at p + origin", "[analysis][origin]") {
  for (int seed = 0; seed < scaled_cases(600); ++seed) {
    const Scene before = scene_of(seed);
    Random random(seed);
    const dvec3 origin = random_origin(random, seed % 2 ? 3 : 30);
    const Scene after = compiler::moved(before, origin);
    INFO("seed " << seed << ", origin " << origin.x << ' ' << origin.y << ' ' << origin.z << '\n'
                 << print(before) << "becomes\n"
                 << print(after));
    for (int i = 0; i < 20; ++i) {
      const dvec3 p = random.in_box(3);
      const Verdict was = judge(before.graph, before.root, p), is = judge(after.graph, after.root, p - origin);
      INFO("at " << p.x << ' ' << p.y << ' ' << p.z);
      CHECK(std::abs(was.distance - is.distance) <= 1e-11 * std::max(1.0, std::abs(was.distance)));
      if (was.margin > 1e-8) CHECK(was.surface == is.surface);
    }
  }
}

TEST_CASE("origin: a scene moved far off and back is as it was, to what a double holds there", "[analysis][origin]") {
  for (int seed = 0; seed < scaled_cases(600); ++seed) {
    const Scene before = scene_of(seed);
    Random random(seed);
    const dvec3 origin = random_origin(random, 1e6);
    const Scene after = compiler::moved(compiler::moved(before, -origin), origin);
    INFO("seed " << seed << '\n' << print(before) << "becomes\n" << print(after));
    for (int i = 0; i < 20; ++i) {
      const dvec3 p = random.in_box(3);
      const double was = judge_distance(before.graph, before.root, p),
                   is = judge_distance(after.graph, after.root, p);
      INFO("at " << p.x << ' ' << p.y << ' ' << p.z);
      CHECK(std::abs(was - is) <= 1e-8 * std::max(1.0, std::abs(was)));
    }
  }
}

// Moving back makes a graph exact again if its branches end in transforms and planes. A node that keeps the scene's
// coordinates below it reports a larger cancellation.
TEST_CASE("origin: float errors of a scene brought back from far are within the bound",
          "[analysis][origin][bounds]") {
  vm::Workspace workspace;
  int fine = 0;
  for (int seed = 0; seed < scaled_cases(400); ++seed) {
    Random random(seed);
    const dvec3 origin = random_origin(random, 1e5);
    const Scene scene = optimised(compiler::moved(compiler::moved(scene_of(seed), -origin), origin));
    const double cancellation = compiler::analyse(scene.graph)[scene.root].cancellation;
    fine += cancellation < 1e3;
    const vm::VerifiedProgram program = verified(*compiler::lower(scene, compiler::Source{}, 100000));
    INFO("seed " << seed << ", magnitude " << cancellation << '\n' << print(scene));
    for (int i = 0; i < 40; ++i) {
      dvec3 p = random.in_box(3);
      for (int step = 0; step < 4; ++step) {
        const vm::SurfaceValue value = vm::evaluate_surface(program, p, workspace);
        p -= value.distance * value.gradient / std::max(1.0, glm::dot(value.gradient, value.gradient));
      }
      const float x = static_cast<float>(p.x), y = static_cast<float>(p.y), z = static_cast<float>(p.z);
      if (!std::isfinite(x + y + z)) continue;
      float narrow;
      vm::evaluate_distance(program, {&x, &y, &z}, 1, &narrow, workspace);
      const double doubles = vm::evaluate_distance(program, dvec3(x, y, z), workspace);
      const double size = std::max({1.0, glm::length(dvec3(x, y, z)), std::abs(doubles)});
      INFO("at " << x << ' ' << y << ' ' << z << ": " << doubles << ' ' << narrow);
      CHECK(std::abs(static_cast<double>(narrow) - doubles) <= vm::kFloatError * (size + cancellation));
    }
  }
  INFO(fine << " of 400 are as exact as near zero");
  CHECK(fine > scaled_cases(300));
}

TEST_CASE("origin: it is zero unless the scene is far from there", "[analysis][origin]") {
  CHECK(origin_of(at("0")) == dvec3(0));
  CHECK(origin_of(at("10")) == dvec3(0));
  CHECK(origin_of(at("100000")) == dvec3(100000, 0, 0));
  CHECK(origin_of(at("-54321.25")) == dvec3(-54320, 0, 0));
  CHECK(origin_of(at("0") + "," + at("100000")) == dvec3(0));  // equally far from both
  CHECK(origin_of(R"({"type": "sphere", "radius": 1e-4, "translate": [5, 0, 0]})") == dvec3(5, 0, 0));
}

// A small object next to a large one; a house in a town.
TEST_CASE("origin: what the camera is close to counts when it is part of the scene", "[analysis][origin]") {
  CHECK(origin_of(at("0"), R"([1, 3, 0.01], "target": [1, 3, 0])") == dvec3(1, 3, 0));
  CHECK(origin_of(at("0") + "," + at("1000"), R"([1000, 3, 5], "target": [1000, 3, 0])") == dvec3(1000, 0, 0));
  // A camera target that only gives a direction.
  CHECK(origin_of(at("0"), R"([0, 3, 100], "target": [0, 3, 99])") == dvec3(0));
}

TEST_CASE("origin: a formula keeps its coordinates, and a steep one the scene's origin", "[analysis][origin]") {
  const auto near_formula = [](const std::string& slope) {
    return origin_of(R"({"type": "expression", "half_size": [1, 1, 1], "formula": ")" + slope + R"(*x - 0.25"})",
                     R"([0.7, 0.7, 0.71], "target": [0.7, 0.7, 0.7])");
  };
  CHECK(near_formula("0.5").x == Approx(0.7).margin(0.01));
  CHECK(near_formula("20") == dvec3(0));
}

// A camera at x that looks along an endless floor shows geometry near x, whatever else is in the scene.
TEST_CASE("origin: of an endless scene the camera's view counts", "[analysis][origin]") {
  const std::string floor = R"({"type": "plane", "normal": [0, 1, 0]})";
  const std::string there = R"([100000, 2, 5], "target": [100000, 1, 0])";
  CHECK(origin_of(floor) == dvec3(0));
  CHECK(origin_of(floor, there).x == 100000);
  CHECK(origin_of(at("100000", kFloor), there).x == 100000);
  CHECK(origin_of(R"({"type": "gyroid", "period": 1})", there).x == 100000);
  // A crater in the floor; an infinite column next to a ball.
  CHECK(origin_of(R"({"type": "subtraction", "of": [{"type": "plane", "normal": [0, 1, 0]}, )" + at("1e5") + "]}",
                  there)
            .x == 100000);
  CHECK(origin_of(R"({"type": "infinite_cylinder", "radius": 1, "translate": [1e5, 0, 0]},)" + at("1e5"), there).x ==
        100000);
  // A mountain at the horizon does not coarsen the ground in front of the camera.
  CHECK(origin_of(floor + R"(, {"type": "sphere", "radius": 100, "translate": [10000, 0, 0]})",
                  R"([0, 2, 0], "target": [10000, 0, 0])") == dvec3(0));
}

TEST_CASE("origin: a scene far off becomes the program of the scene at zero", "[analysis][origin]") {
  const std::string wall = R"(, {"type": "plane", "normal": [1, 0, 0], "offset": )";
  const std::string sail = R"(, {"type": "triangle", "thickness": 0.125, "a": [)";
  const auto scene = [&](double x) {
    const std::string x0 = std::to_string(x), x1 = std::to_string(x + 1), x2 = std::to_string(x - 2);
    const std::string camera = R"({"version": 1, "camera": {"position": [)" + x0 + R"(, 4, 8], "target": [)" + x0 +
                               R"(, 3, 0]}, "objects": [)";
    return compiled(camera +
                    at(x0, kFloor + wall + x2 + "}" + sail + x0 + ", 0, 0], \"b\": [" + x1 + ", 0, 0], \"c\": [" +
                               x0 + ", 2, 1]}") +
                    "]}");
  };
  const auto here = scene(0);
  CHECK(here.origin == dvec3(0));
  for (const double x : {1e3, 1e5, 1e6, -1e6}) {
    const auto there = scene(x);
    INFO(x);
    REQUIRE(there.origin == dvec3(x, 0, 0));
    CHECK(there.distance.program().words == here.distance.program().words);
    CHECK(there.surface.program().words == here.surface.program().words);
    CHECK(there.cancellation == here.cancellation);
    CHECK((there.bound.lo == here.bound.lo && there.bound.hi == here.bound.hi));
    CHECK((there.camera.position == here.camera.position && there.camera.target == here.camera.target));
  }
}

TEST_CASE("origin: what repeats without end is met where the camera is", "[analysis][origin]") {
  const std::string camera = R"({"version": 1, "camera": {"position": [100000.25, 0, 5], "target": [100000, 0, 0]},
      "objects": [)";
  const char* const nodes[] = {
      R"({"type": "repetition", "period": [4, 0, 4], "of": {"type": "sphere", "radius": 1}})",
      R"({"type": "gyroid", "period": 0.8})",
      R"({"type": "infinite_cylinder", "radius": 1, "translate": [100000, 0, 0]})",
      R"({"type": "mirror", "normal": [-1, 0, 0], "offset": -100000.5, "of":
            {"type": "box", "half_size": [1, 1, 1], "translate": [100000, 0, 0]}})",
  };
  vm::Workspace workspace;
  for (const char* node : nodes) {
    compiler::CompileOptions as_read;
    as_read.stop_after = "graph";
    const std::string text = camera + node + "]}";
    const auto scene = compiled(text), plain = compiled(text, as_read);
    INFO(node);
    REQUIRE(scene.origin.x == Approx(100000).margin(4));
    CHECK(plain.origin == dvec3(0));
    CHECK(scene.cancellation < 10);
    Random random(1);
    for (int i = 0; i < 200; ++i) {
      const dvec3 p = random.in_box(8);
      const double was = vm::evaluate_distance(plain.distance, p + scene.origin, workspace);
      CHECK(vm::evaluate_distance(scene.distance, p, workspace) == Approx(was).margin(1e-9));
    }
  }
}

TEST_CASE("origin: what keeps the scene's coordinates says how coarse it is", "[analysis][origin]") {
  // A rotation about an axis a hundred thousand units away.
  const auto scene = compiled_objects(R"({"type": "twist", "turn": 1e-5, "of": {"type": "sphere", "radius": 1,
      "translate": [1e5, 0, 0]}}, {"type": "elongate", "half_size": [0, 0.5, 0], "of": {"type": "sphere",
      "radius": 1, "translate": [0, 1e5, 0]}})");
  CHECK(scene.cancellation >= 9e4);
}

}  // namespace fathom::test::origin_test
