// Tests of every shape: the judge against brute force, the machine against the judge, and the properties that the
// renderer needs of every distance field (a Lipschitz constant, a bounding box). Gradients: normals_test.cpp.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <glm/geometric.hpp>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "compiler/shapes/bounds.h"
#include "tests/compiler/shapes/primitives.h"
#include "tests/support/catch.h"
#include "tests/support/judge/brute_force.h"
#include "tests/support/judge/brute_force_outlines.h"
#include "tests/support/judge/judge.h"
#include "tests/support/plain_lowering.h"
#include "tests/support/scaled_cases.h"

namespace fathom::test::shapes_test {
namespace {

using compiler::Kind;
using compiler::NodeSpec;
using glm::dvec3;

constexpr double kUnit = 0x1p-24;  // rounding error of a float in [1,2)

// Max errors of a kind: the machine's double and float evaluators against the judge.
struct Errors {
  double doubles = 0;  // double, relative to scale_of(p)
  double narrow = 0;  // float, in units of 2^-24 scale_of(p)
  // Like `narrow`, at points within scale / 16 of the surface, where a marching step may end.
  double near = 0;
  std::string where_wide, where_narrow, where_near;
};

Errors measure(Kind kind, int shapes, int points) {
  Errors worst;
  vm::Workspace workspace;
  for (int seed = 0; seed < shapes; ++seed) {
    Random random(static_cast<std::uint64_t>(seed) * 1000 + static_cast<std::uint64_t>(kind));
    const Sample s = sample(kind, random);
    const vm::VerifiedProgram program = plain_lowering(s.scene);
    for (int i = 0; i < points; ++i) {
      const dvec3 p = random_point(random);
      if (estimated(kind) && glm::length(p) < 1e-6) continue;
      const double truth = judge_distance(s.scene.graph, s.scene.root, p), scale = scale_of(p);
      const auto note = [&](double error, double& largest, std::string& where) {
        if (error <= largest) return;  // false for NaN, so that a NaN is recorded
        largest = error;
        where = s.name + " at " + place(p) + ", seed " + std::to_string(seed);
      };
      note(std::abs(vm::evaluate_distance(program, p, workspace) - truth) / scale, worst.doubles, worst.where_wide);
      const double narrow = std::abs(evaluate_float(program, p, workspace).distance - truth) / (scale * kUnit);
      note(narrow, worst.narrow, worst.where_narrow);
      if (std::abs(truth) < scale / 16) note(narrow, worst.near, worst.where_near);
    }
  }
  return worst;
}

bool unbounded(Kind kind) {
  return kind == Kind::Plane || kind == Kind::InfiniteCylinder || kind == Kind::InfiniteCone || periodic(kind);
}

bool exact(const NodeSpec& row) { return row.facts.outside == compiler::Exactness::Exact; }

// True for solids whose formula is a lower bound of the depth inside: a spindle torus, an arc whose ends overlap.
bool inside_is_bound(Kind kind, const std::vector<double>& k) {
  if (kind == Kind::Torus) return k[1] > k[0];
  return kind == Kind::CappedTorus && k[2] > 90 && k[2] < 180 &&
         k[0] * std::sin(k[2] * std::numbers::pi / 180) < k[1];
}

bool is_outline(const NodeSpec& row) { return row.sort == compiler::Sort::Outline; }

// Returns the true distance to a solid, or to an outline for any z.
std::function<double(dvec3)> brute_force(const NodeSpec& row, const std::vector<double>& params) {
  if (is_outline(row)) {
    return [truth = BruteForceOutline(row.kind, params)](dvec3 p) { return truth.distance(glm::dvec2(p)); };
  }
  return [truth = BruteForce(row.kind, params)](dvec3 p) { return truth.distance(p); };
}

}  // namespace

TEST_CASE("random shapes are valid", "[shapes]") {
  for_each_primitive([](const NodeSpec& row) {
    for (std::uint64_t seed = 0; seed < 500; ++seed) {
      Random random(seed);
      const Sample s = sample(row.kind, random);
      INFO(s.name << ", seed " << seed);
      if (row.check) CHECK(row.check(s.params).value_or("") == "");
    }
  });
}

TEST_CASE("the judge finds the distances that brute force finds", "[shapes][judge]") {
  for_each_primitive([](const NodeSpec& row) {
    if (!exact(row)) return;
    for (int seed = 0; seed < scaled_cases(8); ++seed) {
      Random random(seed);
      const Sample s = sample(row.kind, random);
      const auto truth = brute_force(row, s.params);
      for (int i = 0; i < 10; ++i) {
        const dvec3 p = random_point(random);
        const double judged = judge_distance(s.scene.graph, s.scene.root, p), found = truth(p);
        INFO(s.name << ", seed " << seed << ", at " << place(p));
        if (inside_is_bound(row.kind, s.params) && found < 0) {
          // Brute force finds no depths of overlapping arcs.
          if (row.kind == Kind::Torus) CHECK(judged >= found - 1e-12);
          CHECK(judged <= 0);
        } else {
          CHECK(std::abs(judged - found) <= 1e-12 * scale_of(p));
        }
      }
    }
  });
}

TEST_CASE("every primitive in double is the judge's", "[shapes]") {
  for_each_primitive([](const NodeSpec& row) {
    const Errors errors = measure(row.kind, 60, 200);
    INFO(row.name << ": " << errors.where_wide);
    CHECK(errors.doubles <= (estimated(row.kind) ? 1e-9 : 1e-14));
  });
}

TEST_CASE("every primitive in float is within 8 units of the judge's", "[shapes]") {
  for_each_primitive([](const NodeSpec& row) {
    if (estimated(row.kind)) return;
    const Errors errors = measure(row.kind, 60, 200);
    INFO(row.name << ": " << errors.where_narrow);
    CHECK(errors.narrow <= 8);
  });
}

TEST_CASE("table of errors", "[.report]") {
  for_each_primitive([](const NodeSpec& row) {
    const Errors errors = measure(row.kind, 1000, 1000);
    std::printf("%-17s double %9.3g   float %9.3g, near the surface %9.3g x 2^-24   (%s)\n",
                std::string(row.name).c_str(), errors.doubles, errors.narrow, errors.near,
                errors.where_narrow.c_str());
  });
}

TEST_CASE("no field changes faster than its Lipschitz constant", "[shapes]") {
  vm::Workspace workspace;
  const auto check = [&](const compiler::Scene& scene, Random& random, int pairs) {
    const vm::VerifiedProgram program = plain_lowering(scene);
    const double lipschitz = compiler::analyse(scene.graph)[scene.root].lipschitz;
    for (int i = 0; i < pairs; ++i) {
      const dvec3 p = random_point(random);
      const dvec3 q = p + random.direction() * random.length(1e-4, 2);
      const double apart = glm::length(p - q), allowed = lipschitz * apart * (1 + 1e-6) + 1e-12 * scale_of(p);
      INFO("at " << place(p) << ", " << apart << " apart");
      const auto judged = [&](dvec3 at) { return judge_distance(scene.graph, scene.root, at); };
      CHECK(std::abs(judged(p) - judged(q)) <= allowed);
      CHECK(std::abs(vm::evaluate_distance(program, p, workspace) - vm::evaluate_distance(program, q, workspace)) <=
            allowed);
    }
  };
  for_each_primitive([&](const NodeSpec& row) {
    if (estimated(row.kind)) return;
    for (int seed = 0; seed < scaled_cases(16); ++seed) {
      Random random(seed);
      const Sample s = sample(row.kind, random);
      INFO(s.name << ", seed " << seed);
      check(s.scene, random, 60);
    }
  });
  for (int seed = 0; seed < scaled_cases(240); ++seed) {
    Random random(seed);
    const compiler::Scene scene = random_scene(random);
    INFO("random graph, seed " << seed);
    check(scene, random, 30);
  }
}

TEST_CASE("a primitive is nowhere negative outside its box", "[shapes]") {
  for_each_primitive([](const NodeSpec& row) {
    for (int seed = 0; seed < scaled_cases(80); ++seed) {
      Random random(seed);
      const Sample s = sample(row.kind, random);
      const compiler::Box box = row.bound(s.params);
      for (int i = 0; i < 100; ++i) {
        const dvec3 p = random_point(random);
        if (box.contains(p)) continue;
        const double distance = judge_distance(s.scene.graph, s.scene.root, p);
        if (!(distance > -1e-14)) FAIL_CHECK(s.name << ", seed " << seed << ": " << distance << " at " << place(p));
      }
    }
  });
}

// Every side of a finite box touches the surface ("smallest cheap to know"), so that a loose box is noticed.
TEST_CASE("a primitive's box is tight", "[shapes]") {
  for_each_primitive([](const NodeSpec& row) {
    if (estimated(row.kind)) return;
    for (int seed = 0; seed < scaled_cases(16); ++seed) {
      Random random(seed);
      const Sample s = sample(row.kind, random);
      const compiler::Box box = row.bound(s.params);
      INFO(s.name << ", seed " << seed);
      if (unbounded(row.kind)) continue;
      CHECK(box.finite() != is_outline(row));
      for (int side = 0; side < (is_outline(row) ? 4 : 6); ++side) {
        double nearest = 1e9;
        for (int i = 0; i < 400; ++i) {
          dvec3 p(0);
          for (int axis = 0; axis < (is_outline(row) ? 2 : 3); ++axis) {
            p[axis] = i == 0 ? (box.lo[axis] + box.hi[axis]) / 2 : random.uniform(box.lo[axis], box.hi[axis]);
          }
          p[side / 2] = side % 2 ? box.hi[side / 2] : box.lo[side / 2];
          nearest = std::min(nearest, judge_distance(s.scene.graph, s.scene.root, p));
        }
        const dvec3 size = box.hi - box.lo;
        CHECK(nearest <= 0.15 * (is_outline(row) ? std::hypot(size.x, size.y) : glm::length(size)));
      }
    }
  });
}

// Regression: the largest bailout came from the pow of libm, whose last bit differs between machines. At powers 2, 3,
// 6, 9 and 18 the root is a whole number, which one bit less rounds down.
TEST_CASE("a mandelbulb's bailout to its power is at most 10^18, to the unit", "[shapes]") {
  const std::pair<double, double> largest[] = {{2, 1e9}, {3, 1e6}, {4, 31622}, {5, 3981}, {6, 1000}, {7, 372},
                                               {9, 100}, {12, 31}, {17, 11},   {18, 10},  {19, 8},   {24, 5}};
  const NodeSpec& row = compiler::spec(Kind::Mandelbulb);
  for (const auto& [power, bailout] : largest) {
    const auto refused = [&, p = power](double of) { return row.check(std::vector{p, 8.0, of, 0.001}); };
    CAPTURE(power);
    CHECK_FALSE(refused(bailout));
    REQUIRE(refused(bailout + 1));
    CHECK(refused(bailout + 1)->ends_with(" between 2 and " + std::to_string(std::lround(bailout))));
  }
}

}  // namespace fathom::test::shapes_test
