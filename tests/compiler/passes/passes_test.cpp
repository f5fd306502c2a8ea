// Every pass preserves the field and the surfaces, and finds nothing to do in its own result. Lowering preserves the
// meaning of the graph.
#include "compiler/passes/passes.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <string>
#include <vector>

#include "compiler/compile.h"
#include "compiler/graph/rewrite.h"
#include "compiler/lower/lower.h"
#include "compiler/shapes/bounds.h"
#include "compiler/shapes/print_graph.h"
#include "tests/support/catch.h"
#include "tests/support/judge/judge.h"
#include "tests/support/plain_lowering.h"
#include "tests/support/random/random_scene.h"
#include "tests/support/scaled_cases.h"
#include "vm/interpret/evaluate.h"

namespace fathom::test::passes_test {
namespace {

using compiler::Kind;
using compiler::Scene;
using glm::dvec3;

using compiler::Pass;

Scene scene_of(std::uint64_t seed, bool mandelbulbs) {
  Random random(seed);
  GraphOptions options;
  options.depth = 2 + static_cast<int>(seed % 4);
  options.mandelbulbs = mandelbulbs;
  return random_scene(random, options);
}

std::string print(const Scene& scene) { return compiler::print_graph(scene, compiler::Source{}); }

std::size_t nodes(const Scene& scene) {
  const auto reached = compiler::reachable(scene);
  return static_cast<std::size_t>(std::count(reached.begin(), reached.end(), true));
}

// Verdicts of the judge on a scene at random points.
struct Judged {
  std::vector<dvec3> points;
  std::vector<Verdict> verdicts;
};

Judged judged(const Scene& scene, int seed, int points) {
  Judged result;
  Random random(seed);
  for (int i = 0; i < points; ++i) {
    result.points.push_back(random.in_box(3));
    result.verdicts.push_back(judge(scene.graph, scene.root, result.points.back()));
  }
  return result;
}

// Checks that the distances agree (or only their signs, for a pass that preserves no more), and that the surfaces
// agree away from ties.
void check_same(const Judged& before, const Scene& after, const Pass& pass) {
  for (std::size_t i = 0; i < before.points.size(); ++i) {
    const dvec3 p = before.points[i];
    const Verdict &was = before.verdicts[i], is = judge(after.graph, after.root, p);
    INFO("at " << p.x << ' ' << p.y << ' ' << p.z);
    if (pass.leaves == Pass::Leaves::Sign) {
      CHECK((was.distance > 1e-12) == (is.distance > 1e-12));
      continue;
    }
    CHECK(std::abs(was.distance - is.distance) <= 1e-12 * std::max(1.0, std::abs(was.distance)));
    if (pass.run != compiler::strip && was.margin > 1e-9) CHECK(was.surface == is.surface);
  }
}

}  // namespace

TEST_CASE("a pass leaves the field as it was", "[passes]") {
  for (int seed = 0; seed < scaled_cases(600); ++seed) {
    const Scene before = scene_of(seed, false);
    const std::string text = print(before);
    const Judged was = judged(before, seed, 20);
    for (const Pass& pass : compiler::passes()) {
      const Scene after = pass.run(before);
      const std::string becomes = print(after);
      if (becomes == text) continue;
      INFO(pass.name << ", seed " << seed << '\n' << text << "becomes\n" << becomes);
      if (pass.run != compiler::normalise) CHECK(nodes(after) <= nodes(before));
      check_same(was, after, pass);
    }
  }
}

TEST_CASE("a pass has nothing to do on its own result", "[passes]") {
  for (int seed = 0; seed < scaled_cases(600); ++seed) {
    const Scene scene = scene_of(seed, true);
    for (const Pass& pass : compiler::passes()) {
      const Scene once = pass.run(scene);
      INFO(pass.name << ", seed " << seed);
      CHECK(print(pass.run(once)) == print(once));
    }
  }
}

// All passes except those that preserve only the sign.
TEST_CASE("all passes together leave the field as it was, and so does lowering", "[passes][lower]") {
  vm::Workspace workspace;
  for (int seed = 0; seed < scaled_cases(400); ++seed) {
    const Scene before = scene_of(seed, false);
    for (bool keep_paint : {false, true}) {
      Scene after = before;
      for (const Pass& pass : compiler::passes()) {
        const bool skip = pass.leaves == Pass::Leaves::Sign || (keep_paint && pass.run == compiler::strip);
        if (!skip) after = pass.run(after);
      }
      Random random(seed);
      INFO("seed " << seed << (keep_paint ? ", painted" : "") << '\n'
                   << print(before) << "becomes\n"
                   << print(after));
      auto code = compiler::lower(after, compiler::Source{}, 100000);
      REQUIRE(code);
      const vm::VerifiedProgram program = verified(std::move(*code));
      for (int i = 0; i < 20; ++i) {
        const dvec3 p = random.in_box(3);
        const Verdict verdict = judge(before.graph, before.root, p);
        const vm::SurfaceValue value = vm::evaluate_surface(program, p, workspace);
        INFO("at " << p.x << ' ' << p.y << ' ' << p.z << ", margin " << verdict.margin);
        CHECK(std::abs(value.distance - verdict.distance) <= 1e-11 * std::max(1.0, std::abs(verdict.distance)));
        if (keep_paint && verdict.margin > 1e-9) CHECK(value.surface == verdict.surface);
      }
    }
  }
}

TEST_CASE("lowering an unoptimised graph means what it means", "[passes][lower]") {
  vm::Workspace workspace;
  for (int seed = 0; seed < scaled_cases(400); ++seed) {
    const Scene scene = scene_of(seed, false);
    auto code = compiler::lower(scene, compiler::Source{}, 100000);
    REQUIRE(code);
    const vm::VerifiedProgram program = verified(std::move(*code));
    Random random(seed);
    for (int i = 0; i < 20; ++i) {
      const dvec3 p = random.in_box(3);
      const double judged = judge_distance(scene.graph, scene.root, p);
      INFO("seed " << seed << ", at " << p.x << ' ' << p.y << ' ' << p.z << '\n' << print(scene));
      CHECK(std::abs(vm::evaluate_distance(program, p, workspace) - judged) <=
            1e-11 * std::max(1.0, std::abs(judged)));
    }
  }
}

// The innermost paint wins, whatever paint lies around it (compiler/graph/graph.h).
TEST_CASE("paint within paint", "[passes][lower]") {
  Scene scene;
  const auto add = [&](Kind kind, std::vector<double> params, std::vector<compiler::NodeId> children) {
    return scene.graph.add(kind, params, children);
  };
  const auto left = add(Kind::Sphere, {1}, {}), right = add(Kind::Box, {1, 1, 1}, {});
  const auto moved = add(Kind::Transform, transform_params(dvec3(1), {0, 1, 0}, 0, {4, 0, 0}), {right});
  scene.root = add(Kind::Paint, {1}, {add(Kind::Union, {}, {left, add(Kind::Paint, {2}, {moved})})});
  CHECK(judge_surface(scene.graph, scene.root, {0, 2, 0}) == 1);
  CHECK(judge_surface(scene.graph, scene.root, {4, 2, 0}) == 2);
  vm::Workspace workspace;
  const vm::VerifiedProgram program = verified(*compiler::lower(scene, compiler::Source{}, 1000));
  CHECK(vm::evaluate_surface(program, dvec3(0, 2, 0), workspace).surface == 1);
  CHECK(vm::evaluate_surface(program, dvec3(4, 2, 0), workspace).surface == 2);
}

TEST_CASE("a part's own material survives within a painted whole", "[passes][lower]") {
  const std::string text = R"({"version": 1, "materials": {"m": {"type": "diffuse"}, "n": {"type": "diffuse"}},
    "objects": [{"type": "union", "material": "m", "of": [{"type": "sphere", "radius": 1},
      {"type": "sphere", "radius": 1, "translate": [4, 0, 0], "material": "n"}]}]})";
  compiler::Diagnostics diagnostics;
  const auto scene = compiler::compile({"two.json", text}, diagnostics);
  REQUIRE(scene);
  vm::Workspace workspace;
  const auto material_at = [&](dvec3 p) {
    const std::uint32_t surface = vm::evaluate_surface(scene->surface, p, workspace).surface;
    return scene->materials[scene->surfaces[surface].material].name;
  };
  CHECK(material_at({0, 2, 0}) == "m");
  CHECK(material_at({4, 2, 0}) == "n");
}

TEST_CASE("what the compiler knows of a graph is true", "[passes][bounds]") {
  for (int seed = 0; seed < scaled_cases(600); ++seed) {
    const Scene scene = scene_of(seed, false);
    const compiler::NodeFacts known = compiler::analyse(scene.graph)[scene.root];
    Random random(seed);
    INFO("seed " << seed << ", " << compiler::describe(known) << '\n' << print(scene));
    CHECK(known.certified);
    for (int i = 0; i < 60; ++i) {
      const dvec3 p = random.in_box(i % 2 ? 12 : 3);
      const double distance = judge_distance(scene.graph, scene.root, p);
      INFO("at " << p.x << ' ' << p.y << ' ' << p.z);
      if (!known.box.contains(p)) CHECK(distance > -1e-12);
      // Distance outside the box per axis, for its Euclidean and its maximum norm.
      const dvec3 beyond = glm::max(dvec3(0), glm::max(known.box.lo - p, p - known.box.hi));
      const bool outside = !known.box.contains(p);
      if (outside) CHECK(distance >= known.reach * glm::length(beyond) * (1 - 1e-9) - 1e-9);
      if (outside) CHECK(distance >= known.reach_max * std::max({beyond.x, beyond.y, beyond.z}) * (1 - 1e-9) - 1e-9);
      for (int axis = 0; axis < 3; ++axis) {
        dvec3 mirrored = p;
        mirrored[axis] = -p[axis];
        if (known.symmetric[static_cast<std::size_t>(axis)]) {
          CHECK(std::abs(judge_distance(scene.graph, scene.root, mirrored) - distance) <= 1e-9);
        }
      }
      const dvec3 q = p + random.direction() * random.length(1e-3, 1);
      const double allowed = known.lipschitz * glm::length(p - q) * (1 + 1e-6) + 1e-12;
      CHECK(std::abs(distance - judge_distance(scene.graph, scene.root, q)) <= allowed);
    }
  }
}

}  // namespace fathom::test::passes_test
