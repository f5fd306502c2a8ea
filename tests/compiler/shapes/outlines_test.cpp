// Outlines in space: extruded along z and revolved about y, they are as exact as the compiler claims. Outlines alone
// go through the same tests as the solids (shapes_test.cpp).
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "compiler/shapes/make_node.h"
#include "compiler/shapes/node_table.h"
#include "tests/support/catch.h"
#include "tests/support/compiled.h"
#include "tests/support/judge/brute_force_outlines.h"
#include "tests/support/judge/judge_geometry.h"
#include "tests/support/judge/judge_outlines.h"
#include "tests/support/plain_lowering.h"
#include "tests/support/random/random_scene.h"
#include "tests/support/scaled_cases.h"
#include "vm/interpret/evaluate.h"

namespace fathom::test::outlines_test {
namespace {

using compiler::Exactness;
using compiler::Kind;
using compiler::NodeId;
using glm::dvec2;
using glm::dvec3;

struct Made {
  compiler::Scene scene;
  compiler::NodeFacts known;
};

Made over_outline(Kind above, double parameter, Kind kind, const std::vector<double>& params) {
  Made made;
  compiler::NodeMaker maker(made.scene.graph);
  const NodeId outline[] = {maker.make(kind, params, {})};
  const double own[] = {parameter};
  made.scene.root = maker.make(above, own, outline);
  made.known = maker.known(made.scene.root);
  return made;
}

dvec3 point_near_outline(Random& random) { return random.in_box(random.chance(0.8) ? 2 : 8); }

// Compares a value with the true distance: equal if the field is exact there, else nearer to zero with the same sign.
void check(double value, double truth, const compiler::NodeFacts& known) {
  if ((truth < 0 ? known.inside : known.outside) == Exactness::Exact) {
    CHECK(std::abs(value - truth) <= 1e-12 * std::max(1.0, std::abs(truth)));
  } else {
    CHECK(std::abs(value) <= std::abs(truth) + 1e-12);
    CHECK((std::abs(truth) < 1e-9 || (value < 0) == (truth < 0)));
  }
}

template <typename Check>
void for_each_outline(const Check& each) {
  for (const Kind kind : primitive_kinds(compiler::Sort::Outline, false)) {
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      Random random(seed * 1000 + static_cast<std::uint64_t>(kind));
      const std::vector<double> params = random_params(kind, random);
      INFO(compiler::spec(kind).name << ", seed " << seed);
      each(kind, params, random);
    }
  }
}

}  // namespace

TEST_CASE("an outline of straight edges is the polygon of its corners", "[shapes][outlines]") {
  vm::Workspace workspace;
  int straight = 0;
  for_each_outline([&](Kind kind, const std::vector<double>& params, Random& random) {
    const auto corners_of = compiler::spec(kind).corners;
    if (corners_of == nullptr) return;
    ++straight;
    std::vector<dvec2> corners = corners_of(params);
    corners.erase(std::unique(corners.begin(), corners.end()), corners.end());  // of a trapezoid that has a tip
    if (corners.front() == corners.back()) corners.pop_back();
    std::vector<double> points;
    for (const dvec2 corner : corners) points.insert(points.end(), {corner.x, corner.y});
    const vm::VerifiedProgram program = primitive_program(kind, params),
                              polygon = primitive_program(Kind::Polygon, points);
    for (int i = 0; i < 20; ++i) {
      const dvec3 p = point_near_outline(random);
      const double truth = vm::evaluate_distance(polygon, p, workspace);
      CHECK(std::abs(vm::evaluate_distance(program, p, workspace) - truth) <= 1e-13 * (1 + glm::length(p)));
    }
  });
  CHECK(straight == 9 * 20);
}

// The nearest point is on the wall, straight above or below the boundary, or on a cap inside the boundary.
TEST_CASE("an outline drawn along z is as far as brute force says", "[shapes][outlines]") {
  vm::Workspace workspace;
  for_each_outline([&](Kind kind, const std::vector<double>& params, Random& random) {
    const double half_depth = random.length(0.05, 1.5);
    const BruteForceOutline outline(kind, params);
    const Made made = over_outline(Kind::Extrude, half_depth, kind, params);
    const vm::VerifiedProgram program = plain_lowering(made.scene);
    CHECK(made.known.box.lo.z == -half_depth);
    for (int i = 0; i < 20; ++i) {
      const dvec3 p = point_near_outline(random);
      const double flat = outline.distance(dvec2(p)), above = std::abs(p.z) - half_depth;
      const double wall = std::hypot(flat, std::max(0.0, above));
      const double cap = flat < 0 ? std::abs(above) : std::hypot(flat, above);
      const double nearest = std::min(wall, cap);
      check(vm::evaluate_distance(program, p, workspace), flat < 0 && above < 0 ? -nearest : nearest, made.known);
    }
  });
}

// Each point of the boundary becomes a circle, so the nearest point is in the half-plane of p. The outline lies
// beside the axis, or the axis is its mirror line.
TEST_CASE("an outline turned about y is as far as brute force says", "[shapes][outlines]") {
  vm::Workspace workspace;
  int exact = 0;
  for_each_outline([&](Kind kind, const std::vector<double>& params, Random& random) {
    const compiler::Box box = compiler::spec(kind).bound(params);
    const double to_axis = -box.lo.x;  // the offset at which the outline touches the axis from one side
    const double offset = random.chance(0.4) ? 0 : std::max(0.0, to_axis + random.length(1e-3, 1));
    if (offset == 0 && !compiler::spec(kind).facts.symmetric[0]) return;
    const Made made = over_outline(Kind::Revolve, offset, kind, params);
    if (made.known.outside != Exactness::Exact) return;
    ++exact;
    const BruteForceOutline outline(kind, params);
    const vm::VerifiedProgram program = plain_lowering(made.scene);
    for (int i = 0; i < 20; ++i) {
      const dvec3 p = point_near_outline(random);
      check(vm::evaluate_distance(program, p, workspace), outline.distance({std::hypot(p.x, p.z) - offset, p.y}),
            made.known);
    }
  });
  CHECK(exact > 300);
}

namespace {

// Boundary of an outline moved by `offset` along x, without the pieces on the axis or beyond it. The boundary is a
// list of segments: exact for straight edges, chords for curves.
class TurnedBoundary {
 public:
  TurnedBoundary(Kind kind, const std::vector<double>& params, double offset)
      : outline_(kind, params), offset_(offset) {
    for (const Piece& piece : outline_boundary(kind, params)) {
      if (piece.straight) {
        add(piece.a, piece.b);
        continue;
      }
      constexpr int kChords = 256;
      const auto at = [&](int i) {
        const double t = piece.from + (piece.to - piece.from) * i / kChords;
        return piece.centre + dvec2(piece.radii.x * std::cos(t), piece.radii.y * std::sin(t));
      };
      for (int i = 0; i < kChords; ++i) add(at(i), at(i + 1));
      curved_ = true;
    }
  }

  double distance(dvec2 p) const {
    double nearest = std::numeric_limits<double>::infinity();
    for (const auto& [a, b] : segments_) nearest = std::min(nearest, distance_to_segment(p, a, b));
    return outline_.inside({p.x - offset_, p.y}) ? -nearest : nearest;
  }
  bool empty() const { return segments_.empty(); }
  bool curved() const { return curved_; }

 private:
  void add(dvec2 a, dvec2 b) {
    const Piece edge{true, {a.x + offset_, a.y}, {b.x + offset_, b.y}, {}, {}, 0, 0};
    if (const auto beside = beside_axis(edge)) segments_.emplace_back(beside->a, beside->b);
  }

  const BruteForceOutline outline_;
  const double offset_;
  bool curved_ = false;
  std::vector<std::pair<dvec2, dvec2>> segments_;
};

// Checks an outline that is revolved with an edge or a part on the axis or beyond it.
compiler::NodeFacts check_on_axis(Kind kind, const std::vector<double>& params, double offset, Random& random) {
  vm::Workspace workspace;
  const Made made = over_outline(Kind::Revolve, offset, kind, params);
  const TurnedBoundary truth(kind, params, offset);
  const vm::VerifiedProgram program = plain_lowering(made.scene);
  for (int i = 0; i < 20 && !truth.empty(); ++i) {
    dvec3 p = point_near_outline(random);
    if (random.chance(0.3)) p.x = p.z = 0;
    const double value = vm::evaluate_distance(program, p, workspace),
                 distance = truth.distance({std::hypot(p.x, p.z), p.y});
    if (!truth.curved()) {
      check(value, distance, made.known);
    } else if (std::abs(distance) > 1e-3) {
      CHECK((value < 0) == (distance < 0));
      CHECK(std::abs(value) <= std::abs(distance) + 1e-3);
    }
  }
  return made.known;
}

}  // namespace

// Regression: edges on the axis counted as surface, and the compiler called the distance inside exact.
TEST_CASE("an outline with an edge on the axis turns into a solid without a seam", "[shapes][outlines]") {
  int exact = 0, all = 0;
  for_each_outline([&](Kind kind, const std::vector<double>& params, Random& random) {
    const compiler::Box box = compiler::spec(kind).bound(params);
    const double offset = random.chance(0.5) ? -box.lo.x : -box.lo.x - random.uniform(0, 1) * (box.hi.x - box.lo.x);
    const compiler::NodeFacts known = check_on_axis(kind, params, offset, random);
    exact += known.inside == Exactness::Exact;
    ++all;
  });
  CHECK(exact > all / 4);
}

TEST_CASE("a polygon that crosses the axis many times is exact", "[shapes][outlines]") {
  Random random(1);
  const std::vector<double> outlines[] = {
      {0, -2, 2, -2, 2, 2, 0, 2},                                // an edge on the axis
      {0, -2, 2, -2, 2, 2, 0, 2, 0, 1, 0, 0},                    // three edges on the axis
      {-1, -2, 2, -2, 2, 2, -1, 2},                              // crosses the axis
      {2, 3, -2, 3, -2, -3, 2, -3, 2, -1, -1, -1, -1, 1, 2, 1},  // a C whose back is beyond the axis
      {2, 0, 0, 1, -1, 0, 0, -1},                                // corners on the axis
      {0, 0, 2, -1, 2, 1},                                       // touches the axis
      {0, 2, 1, 1, 0, 0, 1, -1, 0, -2, 3, -2, 3, 2},             // touches the axis three times
      {-1, 0, 1, 0.1, -1, 0.2, 1, 0.3, -1, 0.4, 2, 0.5, 2, -1, -2, -1, -2, 0.5}};
  for (const std::vector<double>& points : outlines) {
    for (const double offset : {0.0, 0.25, -0.25}) {
      INFO(points.size() / 2 << " corners, offset " << offset);
      for (int i = 0; i < scaled_cases(20); ++i) {
        const compiler::NodeFacts known = check_on_axis(Kind::Polygon, points, offset, random);
        REQUIRE(known.outside == Exactness::Exact);
        REQUIRE(known.inside == Exactness::Exact);
      }
    }
  }
}

// A profile with moved, rotated and cut parts, each of which has an edge on the axis.
TEST_CASE("parts of an outline are trimmed at the axis wherever they stand", "[shapes][outlines]") {
  vm::Workspace workspace;
  const auto at = [&](const std::string& solid, dvec3 p) {
    return vm::evaluate_distance(test::compiled_objects(solid).distance, p, workspace);
  };
  const std::string rectangle = R"({"type": "rectangle", "half_size": [1, 2], "translate": [1, 0, 0]})";
  const std::string turned =
      R"({"type": "rectangle", "half_size": [2, 1], "rotate": {"axis": [0, 0, 1], "angle": 90}, "translate": [1, 0, 0]})";
  const std::string scaled =
      R"({"type": "trapezoid", "bottom_half_width": 0.5, "top_half_width": 0.5, "half_height": 1,
                                 "translate": [1, 0, 0], "scale": 2})";
  for (const std::string& part : {rectangle, turned, scaled}) {
    INFO(part);
    const std::string solid = R"({"type": "revolve", "of": )" + part + "}";
    CHECK(std::abs(at(solid, dvec3(0)) + 2) < 1e-6);
    CHECK(std::abs(at(R"({"type": "onion", "thickness": 0.1, "of": )" + solid + "}", dvec3(0)) - 1.9) < 1e-6);
    const std::string both = R"({"type": "subtraction", "of": [)" + part +
                             R"(, {"type": "rectangle", "half_size": [1, 0.5], "translate": [1, 2, 0]}]})";
    CHECK(std::abs(at(R"({"type": "revolve", "of": )" + both + "}", dvec3(0)) + 1.5) < 1e-6);
  }
}

}  // namespace fathom::test::outlines_test
