#include "compiler/analysis/probe.h"

#include <cmath>

#include "compiler/derive/formula_field.h"
#include "compiler/lower/lower.h"
#include "compiler/shapes/make_node.h"
#include "tests/support/catch.h"

namespace fathom::probe_test {

namespace {

using namespace fathom::compiler;

const ProbeOptions kOptions{.points = 4000, .reach = 10, .threads = 1};

// A box twisted about y, in a union with a ball, rounded. The level pass has not run.
struct Twisted {
  Scene scene;
  NodeId twist;
};
Twisted twisted(double lipschitz_factor) {
  Twisted out;
  Graph& graph = out.scene.graph;
  NodeMaker maker(graph);
  const double half_size[] = {0.5, 1, 0.5}, turn[] = {120}, radius[] = {0.3};
  const NodeId box[] = {maker.make(Kind::Box, half_size, {})};
  const NodeId made = maker.make(Kind::Twist, turn, box);
  std::vector<double> params(graph.params(made).begin(), graph.params(made).end());
  params[2] *= lipschitz_factor;
  out.twist = graph.add(Kind::Twist, params, box);
  const NodeId arms[] = {out.twist, graph.add(Kind::Sphere, radius, {})};
  const NodeId both[] = {graph.add(Kind::Union, {}, arms)};
  out.scene.root = graph.add(Kind::Round, radius, both);
  return out;
}

}  // namespace

TEST_CASE("a sound twist holds, and comes close to its constant", "[analysis][probe]") {
  const Twisted t = twisted(1);
  const std::vector<ProbeRow> rows = probe(t.scene, {}, kOptions);
  REQUIRE(rows.size() == 2);
  CHECK(rows[0].what == ProbeRow::What::Scene);
  CHECK(rows[0].points == 4000);
  CHECK(rows[1].node == t.twist);
  for (const ProbeRow& row : rows) {
    CHECK_FALSE(row.broken());
    CHECK(row.ratio() > 0.7);
  }
  CHECK(culprits(t.scene, rows).empty());
}

TEST_CASE("a twist whose constant is halved is named, and not what lies above it", "[analysis][probe]") {
  const Twisted t = twisted(0.5);
  const std::vector<ProbeRow> rows = probe(t.scene, {}, kOptions);
  CHECK(rows[0].broken());
  const auto guilty = culprits(t.scene, rows);
  REQUIRE(guilty.size() == 1);
  CHECK(guilty[0]->place.type == "twist");
  CHECK(guilty[0]->place.type == "twist");
}

TEST_CASE("what has no end is probed where the scene is", "[analysis][probe]") {
  Scene scene;
  const double up[] = {0, 1, 0, 0};
  scene.root = scene.graph.add(Kind::Plane, up, {});
  ProbeOptions options = kOptions;
  options.origin = {1e5, 0, 0};
  const std::vector<ProbeRow> rows = probe(scene, {}, options);
  REQUIRE(rows.size() == 1);
  CHECK(std::abs(rows[0].at.x - 1e5) <= 11);
  CHECK(std::abs(rows[0].at.z) <= 11);
}

TEST_CASE("a formula whose constant is halved is named, and an estimate never breaks", "[analysis][probe]") {
  for (const double certified : {1.0, 0.0}) {
    Scene scene;
    Graph& graph = scene.graph;
    NodeMaker maker(graph);
    const double three[] = {3};
    const NodeId product[] = {graph.add(Kind::X, {}, {}), graph.add(Kind::Constant, three, {})};
    const NodeId sum[] = {graph.add(Kind::Multiply, {}, product)};
    SearchAllowance allowance;
    const NodeId sound = make_bounded(maker, sum[0], Box::centred(glm::dvec3(2)), {}, allowance);
    std::vector<double> params(graph.params(sound).begin(), graph.params(sound).end());
    CHECK(params[6] == Approx(3));
    params[6] /= 2;
    params[8] = certified;
    scene.root = graph.add(Kind::Bounded, params, sum);
    const std::vector<ProbeRow> rows = probe(scene, {}, kOptions);
    CHECK(rows[0].gradient == Approx(3));
    CHECK(culprits(scene, rows).size() == certified);
  }
}

TEST_CASE("all rows after the first take no more work than is allowed", "[analysis][probe][limits]") {
  Scene scene;
  Graph& graph = scene.graph;
  NodeMaker maker(graph);
  const double one[] = {1};
  const NodeId ball = graph.add(Kind::Sphere, one, {});
  NodeId last = ball;
  for (int i = 0; i < 12; ++i) {
    // Four doublings, then one more node per step.
    const double x = 1 + 0.1 * i;
    const auto moved = [&](NodeId node, double to) {
      return maker.make(Kind::Transform, std::vector<double>{1, 0, 0, -to, 0, 1, 0, 0, 0, 0, 1, 0, 1}, {{node}});
    };
    const NodeId second = i < 4 ? moved(last, -x) : moved(ball, x);
    last = maker.make(Kind::RoundUnion, one, {{moved(last, x), second}});
  }
  scene.root = last;
  ProbeOptions options{.points = 64, .reach = 10, .threads = 1, .min_work = 50'000};
  std::uint64_t work = 0, seen = 0;
  const std::vector<ProbeRow> rows = probe(scene, {}, options);
  REQUIRE(rows.size() == 12);
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const auto program = lower(graph, rows[i].node, Source("", ""), 1'000'000);
    REQUIRE(program);
    work += rows[i].points * program->debug.size();
    seen += rows[i].points > 0;
  }
  CHECK(work <= options.min_work);
  CHECK(seen >= 3);
  CHECK(rows.back().points == 0);
  options.min_work *= 100;
  CHECK(probe(scene, {}, options).back().points == 64);
}

TEST_CASE("results are the same for any number of threads", "[analysis][probe]") {
  const Twisted t = twisted(1);
  ProbeOptions options{.points = 20000, .reach = 10, .threads = 1};
  const std::vector<ProbeRow> one = probe(t.scene, {}, options);
  options.threads = 5;
  const std::vector<ProbeRow> five = probe(t.scene, {}, options);
  REQUIRE(one.size() == five.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    CHECK(one[i].gradient == five[i].gradient);
    CHECK(one[i].quotient == five[i].quotient);
    CHECK(one[i].at == five[i].at);
    CHECK(one[i].points == five[i].points);
  }
}

}  // namespace fathom::probe_test
