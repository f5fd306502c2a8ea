// Formulas as fields: the bounds that the compiler proves for them, and the boxes of displaced nodes.
#include "compiler/derive/formula_field.h"

#include <fmt/format.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <string>

#include "compiler/derive/formula_bound.h"
#include "compiler/frontend/read_scene.h"
#include "tests/support/catch.h"
#include "tests/support/compiled.h"
#include "tests/support/judge/judge.h"
#include "tests/support/random/random_scene.h"
#include "tests/support/scaled_cases.h"

namespace fathom::test::formula_field_test {
namespace {

using compiler::Box;
using compiler::Kind;
using compiler::NodeFacts;
using compiler::NodeId;
using compiler::Scene;
using glm::dvec3;

// Graph of one object as the front end makes it, before any pass.
Scene scene_of(const std::string& object) {
  compiler::CompileOptions options;
  options.stop_after = "graph";
  Scene graph;
  options.on_pass = [&](std::string_view, const Scene& scene) { graph = scene; };
  test::compiled_objects(object, options);
  return graph;
}

NodeFacts known(const Scene& scene) { return compiler::analyse(scene.graph)[scene.root]; }

NodeFacts of_formula(const std::string& formula) {
  return known(scene_of(R"({"type": "expression", "half_size": [2, 2, 2], "formula": ")" + formula + R"("})"));
}

Scene displaced_ball(const std::string& formula) {
  return scene_of(R"({"type": "displacement", "formula": ")" + formula +
                  R"(", "of": {"type": "sphere", "radius": 1}})");
}

}  // namespace

// A hundred formulas of noise took 6.7 seconds to check, and each further hundred as much again.
TEST_CASE("the searches of many formulas share an allowance", "[derive][formula_field]") {
  const Scene scene =
      scene_of(R"_({"type": "expression", "half_size": [2, 2, 2], "formula": "noise(9*x, 7*y, z)"})_");
  const NodeId formula = scene.graph.children(scene.root)[0];
  const Box box = Box::centred(dvec3(2));
  compiler::SearchAllowance one;
  const double alone = compiler::bound_formula(scene.graph, formula, box, one).lipschitz;
  CHECK(one.left < compiler::SearchAllowance().left);
  compiler::SearchAllowance shared{4};
  double last = 0;
  for (int i = 0; i < 100; ++i) last = compiler::bound_formula(scene.graph, formula, box, shared).lipschitz;
  CHECK(shared.left < 0.1);
  CHECK(last > alone);  // after a shorter search
  CHECK(std::isfinite(last));
}

TEST_CASE("the constants of formulas are close to the slopes that occur", "[derive][formula_field]") {
  const std::pair<const char*, double> cases[] = {
      {"x", 1},
      {"2*x - y + z/2", std::sqrt(5.25)},
      {"sqrt(x^2 + y^2 + z^2) - 1", 1},
      {"x^2 + y^2 - 1", 4 * std::sqrt(2.0)},
      {"sin(3*x)", 3},
      {"x*y*z", std::sqrt(48.0)},
      {"max(abs(x), abs(y)) - 1", 1},
      {"sin(x)*cos(y) + sin(y)*cos(z) + sin(z)*cos(x)", 1.73},
  };
  for (const auto& [formula, slope] : cases) {
    INFO(formula);
    const NodeFacts k = of_formula(formula);
    CHECK(k.certified);
    CHECK(k.lipschitz >= slope * (1 - 1e-12));
    CHECK(k.lipschitz <= slope * 1.2);
  }
}

TEST_CASE("formulas that jump or have poles are estimates", "[derive][formula_field]") {
  for (const char* formula : {"floor(3*x) - y", "1/x", "sqrt(x)", "tan(x)", "x + sign(y)"}) {
    INFO(formula);
    const NodeFacts k = of_formula(formula);
    CHECK(!k.certified);
    CHECK(k.outside == compiler::Exactness::Estimate);
    CHECK(std::isfinite(k.lipschitz));
  }
}

// Formulas of hundreds of pieces. The specialised parts that prove the bound hold a few pieces each.
TEST_CASE("the bounds of formulas of many pieces hold", "[derive][formula_field]") {
  for (int seed = 0; seed < scaled_cases(6); ++seed) {
    Random random(seed);
    std::string formula = "1";
    double steepest = 0;
    for (int i = 0; i < 200; ++i) {
      const double x = random.uniform(-2, 2), y = random.uniform(-2, 2), slope = random.uniform(0.2, 3);
      const char* const kind =
          seed % 2 == 0 ? "max(abs(x - {0:.4f}), abs(y - {1:.4f}))" : "length(x - {0:.4f}, y - {1:.4f})";
      const std::string place = fmt::format(fmt::runtime(kind), x, y);
      formula = fmt::format("{}({}, {:.4f}*{} - 0.1)", i % 7 == 0 ? "max" : "min", formula,
                            i % 7 == 0 ? -slope : slope, place);
      steepest = std::max(steepest, slope);
    }
    INFO("seed " << seed);
    const Scene scene =
        scene_of(R"({"type": "expression", "half_size": [2, 2, 2], "formula": ")" + formula + R"("})");
    compiler::NodeId bounded = scene.root;
    while (scene.graph.kind(bounded) != Kind::Bounded) bounded = scene.graph.children(bounded)[0];
    const compiler::NodeId node = scene.graph.children(bounded)[0];
    compiler::SearchAllowance allowance;
    const compiler::FormulaBound bound =
        compiler::bound_formula(scene.graph, node, Box::centred(dvec3(2)), allowance);
    CHECK(bound.seen <= bound.lipschitz);
    CHECK(bound.lipschitz <= steepest * 1.0001);
    dvec3 before = random.in_box(2);
    for (int i = 0; i < 1000; ++i) {
      const dvec3 p = i % 2 == 0 ? random.in_box(2) : glm::clamp(before + random.in_box(0.01), dvec3(-2), dvec3(2));
      const double value = judge_distance(scene.graph, node, p), last = judge_distance(scene.graph, node, before);
      REQUIRE((value >= bound.least && value <= bound.most));
      REQUIRE(std::abs(value - last) <= bound.lipschitz * glm::length(p - before) * (1 + 1e-9) + 1e-12);
      before = p;
    }
  }
}

// Regression: the compiler grew the box four times and then used the box even if the formula's bound did not hold
// over it.
TEST_CASE("a displaced node's box holds it", "[derive][formula_field]") {
  for (const char* formula :
       {"0.5*x", "0.9*y", "0.3*sin(5*x)", "-0.2", "0.1*x*y", "0.05*x^2 - 0.5", "0.4*x + 0.4*y", "-0.4*abs(x)"}) {
    INFO(formula);
    const Scene scene = displaced_ball(formula);
    const NodeFacts k = known(scene);
    INFO(compiler::describe(k));
    CHECK(k.certified);
    CHECK(k.box.finite());
    Random random(3);
    for (int i = 0; i < 20000; ++i) {
      const dvec3 p = random.in_box(12);
      // `free` is the distance of the displaced ball without the box.
      const compiler::NodeId sum = scene.graph.children(scene.root)[0];
      const double free = judge_distance(scene.graph, sum, p), boxed = judge_distance(scene.graph, scene.root, p);
      if (!k.box.contains(p)) REQUIRE(free > 0);
      REQUIRE((boxed < 0) == (free < 0));
    }
  }
}

TEST_CASE("a ball that grows faster than the way walked has no end, and a constant all the same",
          "[derive][formula_field]") {
  const NodeFacts k = known(displaced_ball("-2*x"));
  CHECK(k.certified);
  CHECK(!k.box.finite());
  CHECK(k.lipschitz == Approx(3));
  CHECK(!known(displaced_ball("x*y")).certified);
}

}  // namespace fathom::test::formula_field_test
