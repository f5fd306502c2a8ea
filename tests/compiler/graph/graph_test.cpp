// Tests of hash-consing and of the graph's listing.
#include "compiler/graph/graph.h"

#include <cmath>
#include <limits>

#include "compiler/shapes/print_graph.h"
#include "tests/support/catch.h"

namespace fathom::graph_test {

namespace {

using namespace fathom::compiler;

NodeId sphere(Graph& graph, double radius) {
  const double params[] = {radius};
  return graph.add(Kind::Sphere, params, {});
}

TEST_CASE("equal nodes are one", "[graph]") {
  Graph graph;
  const NodeId a = sphere(graph, 1), b = sphere(graph, 2);
  CHECK(a != b);
  CHECK(sphere(graph, 1) == a);
  const NodeId ab[] = {a, b}, ba[] = {b, a};
  const NodeId u = graph.add(Kind::Union, {}, ab);
  CHECK(graph.add(Kind::Union, {}, ab) == u);
  CHECK(graph.add(Kind::Union, {}, ba) != u);
  CHECK(graph.add(Kind::Intersection, {}, ab) != u);
  CHECK(graph.add(Kind::Union, {}, std::span(ab).first(1)) != u);
  CHECK(graph.size() == 6);
  CHECK(graph.children(u).size() == 2);
  CHECK(graph.params(a)[0] == 1);
  CHECK(graph.kind(u) == Kind::Union);
}

TEST_CASE("parameters are compared by their bits, but for the sign of zero", "[graph]") {
  Graph graph;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK(sphere(graph, 0.0) == sphere(graph, -0.0));
  CHECK(!std::signbit(graph.params(sphere(graph, -0.0))[0]));
  CHECK(sphere(graph, nan) == sphere(graph, nan));
  CHECK(sphere(graph, 0.1) != sphere(graph, std::nextafter(0.1, 1.0)));
  CHECK(sphere(graph, std::numeric_limits<double>::infinity()) != sphere(graph, nan));
}

TEST_CASE("a node may be made from parts of the graph itself", "[graph]") {
  Graph graph;
  NodeId last = sphere(graph, 1);
  for (int i = 0; i < 1000; ++i) {
    const NodeId children[] = {last};
    last = graph.add(Kind::Round, graph.params(0), children);
    last = graph.add(Kind::Union, {}, graph.children(last));
    CHECK(graph.params(last).empty());
  }
}

TEST_CASE("the first origin of a node is kept", "[graph]") {
  Graph graph;
  const double params[] = {1.0};
  graph.add(Kind::Sphere, params, {}, {{3, 5}, "first"});
  graph.add(Kind::Sphere, params, {}, {{7, 9}, "second"});
  CHECK(graph.size() == 1);
  CHECK(graph.origin(0).name == "first");
  CHECK(graph.origin(0).span.begin == 3);
}

TEST_CASE("the listing shows what the root reaches, renumbered", "[graph]") {
  const Source source("scene.json", "\n\n  {}");
  Scene scene;
  Graph& graph = scene.graph;
  sphere(graph, 99);
  const double half[] = {1, 0.1, 1e-7};
  const NodeId box = graph.add(Kind::Box, half, {}, {{4, 6}, "crate"});
  const double radius[] = {0.25};
  const NodeId ball = graph.add(Kind::Sphere, radius, {}, {{4, 6}, ""});
  const double moved[] = {1, 0, 0, -2, 0, 1, 0, 0, 0, 0, 1, -0.0, 1};
  const NodeId child[] = {ball};
  const NodeId transform = graph.add(Kind::Transform, moved, child);
  const double surface[] = {3};
  const NodeId inner[] = {transform};
  const NodeId paint = graph.add(Kind::Paint, surface, inner);
  const double k[] = {0.5};
  const NodeId both[] = {box, paint, box};
  scene.root = graph.add(Kind::SmoothUnion, k, both);
  sphere(graph, 98);
  CHECK(print_graph(scene, source) ==
        "%0 = box half_size=[1,0.1,1e-07]    ; \"crate\" scene.json:3:3\n"
        "%1 = sphere radius=0.25             ; scene.json:3:3\n"
        "%2 = transform rows=[1,0,0,-2,0,1,0,0,0,0,1,0] factor=1 %1\n"
        "%3 = paint surface=3 %2\n"
        "%4 = smooth_union k=0.5 %0 %3 %0\n");
}

}  // namespace

}  // namespace fathom::graph_test
