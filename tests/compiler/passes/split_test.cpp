// A scene is the union of its pieces: the same signs and surfaces everywhere, and the same distances where no cut was
// left out.
#include "compiler/passes/split.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "compiler/graph/rewrite.h"
#include "compiler/passes/passes.h"
#include "compiler/shapes/bounds.h"
#include "tests/support/catch.h"
#include "tests/support/compiled.h"
#include "tests/support/judge/judge.h"
#include "tests/support/random/random_scene.h"
#include "tests/support/scaled_cases.h"

namespace fathom::test::split_test {
namespace {

using compiler::Graph;
using compiler::Kind;
using compiler::NodeId;
using compiler::Pieces;
using compiler::Scene;

// Returns the graph of a text after the passes, with Paint.
Scene painted(const std::string& text) {
  Scene scene;
  compiler::CompileOptions options;
  options.on_pass = [&](std::string_view name, const Scene& after) {
    if (name == "graph") scene = after;
  };
  compiled("fathom 1\n" + text + "\n", options);
  for (const compiler::Pass& pass : compiler::passes()) {
    if (pass.run != compiler::strip) scene = pass.run(scene);
  }
  return scene;
}

std::size_t pieces_of(const std::string& text) { return compiler::split(painted(text)).nodes.size(); }

// Returns a scene beside a moved copy of it, cut by a ball that meets both.
Scene twice(Scene scene) {
  Graph& graph = scene.graph;
  const std::vector<double> aside = transform_params({1, 1, 1}, {0, 1, 0}, 0.5, {3, 0.5, 0}), radius = {1.5};
  const NodeId copy[] = {scene.root, graph.add(Kind::Transform, aside, {&scene.root, 1})};
  const NodeId operands[] = {graph.add(Kind::Union, {}, copy), graph.add(Kind::Sphere, radius, {})};
  scene.root = graph.add(Kind::Subtraction, {}, operands);
  return scene;
}

// The nearest piece, of equally near ones the first.
Verdict judge_pieces(const Pieces& pieces, glm::dvec3 p) {
  Verdict nearest = judge(pieces.graph, pieces.nodes[0], p);
  double second = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < pieces.nodes.size(); ++i) {
    const Verdict next = judge(pieces.graph, pieces.nodes[i], p);
    second = std::min(second, std::max(next.distance, nearest.distance));
    if (next.distance < nearest.distance) nearest = next;
  }
  nearest.margin = std::min(nearest.margin, second - nearest.distance);
  return nearest;
}

}  // namespace

TEST_CASE("split: random scenes are the union of their pieces", "[passes][split]") {
  std::size_t divided = 0;
  for (int seed = 0; seed < scaled_cases(1200); ++seed) {
    Random random(seed);
    GraphOptions graph;
    graph.depth = 2 + seed % 4;
    const Scene scene = twice(random_scene(random, graph));
    const Pieces pieces = compiler::split(scene);
    divided += pieces.nodes.size() > 1;
    INFO("seed " << seed);
    for (int i = 0; i < 20; ++i) {
      const glm::dvec3 p = random.in_box(3);
      const Verdict whole = judge(scene.graph, scene.root, p), parts = judge_pieces(pieces, p);
      INFO("at " << p.x << ' ' << p.y << ' ' << p.z);
      if (std::abs(whole.distance) > 1e-9) CHECK((whole.distance > 0) == (parts.distance > 0));
      // Cuts that a piece leaves out lower distances outside all boxes, and none inside.
      CHECK(parts.distance <= whole.distance + 1e-9 * std::max(1.0, std::abs(whole.distance)));
      if (whole.distance < 0 && whole.margin > 1e-9 && parts.margin > 1e-9) CHECK(whole.surface == parts.surface);
    }
  }
  CHECK(divided > static_cast<std::size_t>(scaled_cases(300)));
}

TEST_CASE("split: each piece's box holds it, and boxes hold all of the scene", "[passes][split]") {
  for (int seed = 0; seed < scaled_cases(300); ++seed) {
    Random random(seed);
    const Scene scene = random_scene(random, {});
    const Pieces pieces = compiler::split(scene);
    const std::vector<compiler::NodeFacts> facts = compiler::analyse(pieces.graph);
    for (int i = 0; i < 50; ++i) {
      const glm::dvec3 p = random.in_box(3);
      if (!(judge_distance(scene.graph, scene.root, p) < -1e-9)) continue;
      INFO("seed " << seed);
      CHECK(std::ranges::any_of(pieces.nodes, [&](compiler::NodeId node) { return facts[node].box.contains(p); }));
    }
  }
}

TEST_CASE("split: unions divide, also below moves, offsets, cuts and limits", "[passes][split]") {
  const std::string row = "union([for i in 0..40: sphere(0.5).translate([2*i, 0, 0])])";
  CHECK(pieces_of("object " + row) == 40);
  CHECK(pieces_of("object " + row + ".rotate([0, 20, 0]).translate([3, 0, 0])") == 40);
  CHECK(pieces_of("object " + row + ".round(0.1)") == 40);
  CHECK(pieces_of("object " + row + " - box([200, 0.1, 200])") == 40);
  CHECK(pieces_of("object box([200, 0.1, 200]) & " + row) == 40);
  const std::string long_row = "union([for i in 0..200: sphere(0.5).translate([2*i, 0, 0])])";
  CHECK(pieces_of("object plane([0, 1, 0], offset = -2)\nobject " + long_row) == 201);
}

TEST_CASE("split: proved arms leave those without a proof", "[passes][split]") {
  CHECK(pieces_of("object torus(1, 0.2)\nobject torus(1, 0.2).translate([9, 0, 0])") == 1);
  CHECK(pieces_of("object sphere(1)\nobject mandelbulb().translate([9, 0, 0])") == 2);
}

TEST_CASE("split: blends, shells and bent unions stay one piece", "[passes][split]") {
  const std::string apart = "(sphere(1) + box([1, 1, 1]).translate([9, 0, 0]))";
  CHECK(pieces_of("object sphere(1) +{0.1} box([1, 1, 1]).translate([9, 0, 0])") == 1);
  CHECK(pieces_of("object " + apart + ".onion(0.1)") == 1);
  CHECK(pieces_of("object " + apart + ".twist(1)") == 1);
}

TEST_CASE("split: cheap parts in each other's boxes stay one piece, unless rays have formulas", "[passes][split]") {
  CHECK(pieces_of("object torus(1, 0.2)\nobject torus(1, 0.2).translate([0.1, 0, 0])") == 1);
  CHECK(pieces_of("object sphere(1)\nobject sphere(1).translate([0.1, 0, 0])") == 2);
}

TEST_CASE("split: a cut that does not reach a piece is left out of it", "[passes][split]") {
  const Pieces pieces = compiler::split(
      painted("object mandelbulb() + box([1, 1, 1]).translate([9, 0, 0]) - sphere(0.5).translate([9, 1, 0])"));
  REQUIRE(pieces.nodes.size() == 2);
  std::size_t cuts = 0;
  for (const NodeId node : pieces.nodes) {
    const std::vector<bool> reached = compiler::reachable(pieces.graph, node);
    for (NodeId id = 0; id <= node; ++id) cuts += reached[id] && pieces.graph.kind(id) == Kind::Subtraction;
  }
  CHECK(cuts == 1);
}

TEST_CASE("split: many arms that all meet many cuts stay one piece", "[passes][split]") {
  CHECK(pieces_of("object union([for i in 0..40: box([0.1, 5, 0.1]).translate([i, 0, 0])]) - "
                  "union([for i in 0..40: box([50, 0.05, 0.2]).translate([0, 0.2*i - 4, 0])])") == 1);
}

TEST_CASE("split: convex are moved, rounded and intersected convex solids", "[passes][split]") {
  const auto convex = [](const std::string& text) {
    const Scene scene = painted("object " + text);
    return compiler::is_convex(scene.graph, scene.root);
  };
  CHECK(convex("box([1, 2, 3]).rotate([20, 0, 0]).translate([1, 0, 0])"));
  CHECK(convex("(sphere(1) & box([1, 1, 0.5])).round(0.1)"));
  CHECK_FALSE(convex("torus(1, 0.2)"));
  CHECK_FALSE(convex("sphere(1) + sphere(1).translate([9, 0, 0])"));
  CHECK_FALSE(convex("sphere(1) - sphere(0.5).translate([1, 0, 0])"));
  CHECK_FALSE(convex("sphere(1).translate([1, 0, 0]).mirror([1, 0, 0])"));
}

}  // namespace fathom::test::split_test
