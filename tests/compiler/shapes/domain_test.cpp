// Regression tests of folded, repeated and bent space. The general tests use random graphs (passes_test.cpp) and rays
// (tests/catalogue/warps_test.cpp).
#include <glm/geometric.hpp>
#include <numbers>
#include <string>

#include "compiler/derive/formula_field.h"
#include "compiler/shapes/bounds.h"
#include "tests/support/catch.h"
#include "tests/support/judge/judge.h"
#include "tests/support/plain_lowering.h"
#include "tests/support/random/random_scene.h"
#include "tests/support/scaled_cases.h"
#include "vm/interpret/evaluate.h"

namespace fathom::test::domain_test {
namespace {

using compiler::Kind;
using compiler::NodeId;
using compiler::NodeMaker;
using compiler::Scene;
using glm::dvec3;

NodeId over(NodeMaker& maker, Kind kind, const std::vector<double>& params, NodeId child) {
  const NodeId children[] = {child};
  REQUIRE(!maker.complaint(kind, params, children));
  return maker.make(kind, params, children);
}

// Solid with a small Lipschitz constant: its value changes by at most 1/200 of the distance moved.
NodeId gentle(NodeMaker& maker, dvec3 lo, dvec3 hi) {
  const NodeId x = maker.make(Kind::X, {}, {});
  const NodeId operands[] = {x, maker.make(Kind::Constant, {{0.005}}, {})};
  compiler::SearchAllowance allowance;
  return compiler::make_bounded(maker, maker.make(Kind::Multiply, {}, operands), {lo, hi}, {}, allowance);
}

// Checks that no value changes faster than the node's Lipschitz constant allows, in double, by the judge and by the
// machine.
void check_slopes(const Scene& scene, double size) {
  const vm::VerifiedProgram program = plain_lowering(scene);
  const double lipschitz = compiler::analyse(scene.graph)[scene.root].lipschitz;
  vm::Workspace workspace;
  Random random(1);
  for (int i = 0; i < scaled_cases(8000); ++i) {
    const dvec3 p = random.in_box(size), q = p + random.direction() * random.length(1e-4, 1);
    const double allowed = lipschitz * glm::length(p - q) * (1 + 1e-6) + 1e-12;
    const double a = judge_distance(scene.graph, scene.root, p), b = judge_distance(scene.graph, scene.root, q);
    INFO(p.x << ' ' << p.y << ' ' << p.z << " to " << q.x << ' ' << q.y << ' ' << q.z << ", Lipschitz " << lipschitz);
    REQUIRE(std::abs(a - b) <= allowed);
    REQUIRE(std::abs(vm::evaluate_distance(program, p, workspace) - a) <= 1e-9);
  }
}

}  // namespace

// Regression: these nodes kept a child's Lipschitz constant below 1, although the distance to their own box is part
// of the result.
TEST_CASE("what adds a distance of its own changes by at least that", "[shapes][domain]") {
  const auto check = [](Kind kind, const std::vector<double>& params, dvec3 lo, dvec3 hi) {
    Scene scene;
    NodeMaker maker(scene.graph);
    const NodeId child = gentle(maker, lo, hi);
    REQUIRE(maker.known(child).lipschitz < 0.01);
    scene.root = over(maker, kind, params, child);
    INFO(compiler::spec(kind).name);
    check_slopes(scene, 4);
  };
  check(Kind::PolarRepetition, {12}, {1.5, -1, -0.2}, {2.5, 1, 0.2});
  check(Kind::Bend, {30}, {-1, -0.5, -0.5}, {1, 0.5, 0.5});
  check(Kind::Elongate, {0.5, 0.5, 0.5}, {-1, -1, -1}, {1, 1, 1});
  check(Kind::Extrude, {0.5}, {-1, -1, -1}, {1, 1, 1});
  check(Kind::Repetition, {3, 0, 0, 0, 0, 0, 0, 0, 0}, {-0.5, -1, -1}, {1, 1, 1});
  check(Kind::Twist, {90}, {-1, -1, -1}, {1, 1, 1});
  check(Kind::Taper, {1, 0.5, 1}, {-1, -1, -1}, {1, 1, 1});
}

// Regression: along an axis without jitter only the nearest copy was evaluated. The neighbour is not a mirror image
// of that copy if the copies are jittered along another axis.
TEST_CASE("copies that are moved along one axis have neighbours along the others", "[shapes][domain]") {
  for (int axis = 0; axis < 3; ++axis) {
    Scene scene;
    NodeMaker maker(scene.graph);
    std::vector<double> params = {1.5, 1.5, 1.5, 0, 0, 0, 0, 0, 0};
    params[static_cast<std::size_t>(6 + axis)] = 0.4;
    scene.root = over(maker, Kind::Repetition, params, maker.make(Kind::Sphere, {{0.3}}, {}));
    INFO("jitter along "
         << "xyz"[axis]);
    check_slopes(scene, 6);
  }
}

// Regression: the lower bound for omitted copies was 0 on the axis, where all half-planes meet, so rays along the
// axis hit something that is not there.
TEST_CASE("the axis of a polar repetition is as far from the copies as they are", "[shapes][domain]") {
  Scene scene;
  NodeMaker maker(scene.graph);
  const NodeId ball = maker.make(Kind::Sphere, {{0.2}}, {});
  scene.root = over(maker, Kind::PolarRepetition, {24},
                    over(maker, Kind::Transform, transform_params(dvec3(1), {0, 1, 0}, 0, {2, 0, 0}), ball));
  check_slopes(scene, 3);
  vm::Workspace workspace;
  const vm::VerifiedProgram program = plain_lowering(scene);
  CHECK(vm::evaluate_distance(program, {0, 0, 0}, workspace) == Approx(1.8));
  CHECK(vm::evaluate_distance(program, {1e-3, 0, 0}, workspace) == Approx(1.799));
}

// Regression: each copy rounded the side of a cell differently, and just below the side one copy was omitted: a slit
// through the solid.
TEST_CASE("no copy is lost at the side of a cell", "[shapes][domain]") {
  const auto check = [](Kind kind, const std::vector<double>& params, dvec3 ball, double radius, dvec3 side,
                        dvec3 step) {
    Scene scene;
    NodeMaker maker(scene.graph);
    scene.root = over(maker, kind, params,
                      over(maker, Kind::Transform, transform_params(dvec3(1), {0, 1, 0}, 0, ball),
                           maker.make(Kind::Sphere, std::vector<double>{radius}, {})));
    const vm::VerifiedProgram program = plain_lowering(scene);
    vm::Workspace workspace;
    const double there = judge_distance(scene.graph, scene.root, side);
    for (int i = -1000; i <= 1000; ++i) {
      const dvec3 p = side + step * static_cast<double>(i);
      INFO(p.x << ' ' << p.y << ' ' << p.z);
      CHECK(std::abs(vm::evaluate_distance(program, p, workspace) - there) < 1e-6);
      const float x = static_cast<float>(p.x), y = static_cast<float>(p.y), z = static_cast<float>(p.z);
      float value;
      vm::evaluate_distance(program, {&x, &y, &z}, 1, &value, workspace);
      CHECK(std::abs(static_cast<double>(value) - there) < 3e-6);
    }
  };
  for (const double cell : {0.0, 1.0, 2.0, 8.0, -3.0}) {
    check(Kind::Repetition, {1, 0, 0, 0, 0, 0, 0, 0, 0}, {0.01, 0, 0}, 0.3, {cell, 0, 0}, {0x1p-54, 0, 0});
    check(Kind::Repetition, {1, 0, 0, 20, 0, 0, 0, 0, 0}, {0.01, 0, 0}, 0.3, {cell + 0.5, 0, 0}, {0x1p-54, 0, 0});
    check(Kind::Repetition, {1, 0, 0, 0, 0, 0, 0, 0.1, 0}, {0.01, 0, 0}, 0.3, {cell, 0, 0}, {0x1p-54, 0, 0});
  }
  for (const int copy : {0, 1, 7, 10, 13}) {
    const double angle = copy * std::numbers::pi / 10;
    const dvec3 middle(2 * std::cos(angle), 0, 2 * std::sin(angle));
    check(Kind::PolarRepetition, {20}, {2, 0, 0}, 0.1, middle, dvec3(-middle.z, 0, middle.x) * 0x1p-53);
  }
}

// Regression: beyond the last copies, the machine evaluated the last copy repeatedly instead of its neighbours.
TEST_CASE("beyond the last copies their neighbours still count", "[shapes][domain]") {
  Scene scene;
  NodeMaker maker(scene.graph);
  const auto ball = [&](dvec3 at) {
    return over(maker, Kind::Transform, transform_params(dvec3(1), {0, 1, 0}, 0, at),
                maker.make(Kind::Sphere, {{0.1}}, {}));
  };
  const NodeId both[] = {ball({1.6, 0, 0}), ball({0.1, 5, 0})};
  scene.root = over(maker, Kind::Repetition, {1, 0, 0, 5, 1, 1, 0, 0, 0}, maker.make(Kind::Union, {}, both));
  check_slopes(scene, 8);
  vm::Workspace workspace;
  CHECK(vm::evaluate_distance(plain_lowering(scene), {3.0001, 0, 0}, workspace) == Approx(0.3001));
}

// Regression: a mirror normal whose squares underflow was not normalised.
TEST_CASE("mirrors of any length of normal are the same mirror", "[shapes][domain]") {
  vm::Workspace workspace;
  for (const double length : {1.0, 1e-161, 1e-300, 1e200}) {
    Scene scene;
    NodeMaker maker(scene.graph);
    scene.root = over(maker, Kind::Mirror, {length, 0, 0, 0},
                      over(maker, Kind::Transform, transform_params(dvec3(1), {0, 1, 0}, 0, {2, 0, 0}),
                           maker.make(Kind::Sphere, {{1.0}}, {})));
    CHECK(vm::evaluate_distance(plain_lowering(scene), {-2, 0, 0}, workspace) == -1);
    CHECK(maker.known(scene.root).box.lo.x == -3);
  }
}

// Regression: the compiler assumed that a child symmetric about the plane stays exact under Elongate. In the middle
// the child's nearest point can lie off the plane.
TEST_CASE("a node pulled apart is a bound", "[shapes][domain]") {
  Scene scene;
  NodeMaker maker(scene.graph);
  scene.root = over(maker, Kind::Elongate, {1, 0, 0}, maker.make(Kind::BoxFrame, {{0.5, 1.0, 1.0, 0.1}}, {}));
  CHECK(maker.known(scene.root).outside == compiler::Exactness::Bound);
  CHECK(judge_distance(scene.graph, scene.root, {0, 0, 0}) < 0.9);  // the true distance is 1.1
}

// Regression: the number of copies of a tiny period overflowed an int.
TEST_CASE("more copies than can be counted are refused", "[shapes][domain]") {
  Scene scene;
  NodeMaker maker(scene.graph);
  const NodeId ball = maker.make(Kind::Sphere, {{1.0}}, {});
  const NodeId children[] = {ball};
  for (const double period : {1e-3, 1e-17, 1e-300}) {
    CHECK(maker.complaint(Kind::Repetition, std::vector<double>{period, 0, 0, 0, 0, 0, 0, 0, 0}, children));
  }
}

}  // namespace fathom::test::domain_test
