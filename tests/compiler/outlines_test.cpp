// Outlines in space: drawn along z and turned about y they are as exact as what is known of them says. Alone they go
// through the same suite as the solids (shapes_test.cpp).
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <glm/geometric.hpp>

#include "compiler/make_node.h"
#include "compiler/shapes/node_table.h"
#include "tests/support/brute_force_outlines.h"
#include "tests/support/plain_lowering.h"
#include "tests/support/random_scene.h"
#include "vm/evaluate.h"

namespace fathom::test {
namespace {

using compiler::Exactness;
using compiler::Kind;
using compiler::NodeId;
using glm::dvec2;
using glm::dvec3;

struct Made {
  compiler::Scene scene;
  compiler::Knowledge known;
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

dvec3 random_point(Random& random) { return random.in_box(random.chance(0.8) ? 2 : 8); }

// A value against the truth: equal where exact, else nearer to the surface on the same side.
void check(double value, double truth, const compiler::Knowledge& known) {
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

// The nearest point is on the wall, straight above or below the boundary, or on a cap within it.
TEST_CASE("an outline drawn along z is as far as brute force says", "[outlines]") {
  vm::Workspace workspace;
  for_each_outline([&](Kind kind, const std::vector<double>& params, Random& random) {
    const double half_depth = random.length(0.05, 1.5);
    const BruteForceOutline outline(kind, params);
    const Made made = over_outline(Kind::Extrude, half_depth, kind, params);
    const vm::VerifiedProgram program = plain_lowering(made.scene);
    CHECK(made.known.box.lo.z == -half_depth);
    for (int i = 0; i < 20; ++i) {
      const dvec3 p = random_point(random);
      const double flat = outline.distance(dvec2(p)), above = std::abs(p.z) - half_depth;
      const double wall = std::hypot(flat, std::max(0.0, above));
      const double cap = flat < 0 ? std::abs(above) : std::hypot(flat, above);
      const double nearest = std::min(wall, cap);
      check(vm::evaluate_distance(program, p, workspace), flat < 0 && above < 0 ? -nearest : nearest, made.known);
    }
  });
}

// Every point of the boundary on this side of the axis becomes a circle: the nearest is in the half-plane of p. Where
// the outline crosses the axis its other half is cut off, or is the mirror image.
TEST_CASE("an outline turned about y is as far as brute force says", "[outlines]") {
  vm::Workspace workspace;
  int exact = 0;
  for_each_outline([&](Kind kind, const std::vector<double>& params, Random& random) {
    const compiler::Box box = compiler::spec(kind).bound(params);
    const double to_axis = -box.lo.x;  // touches the axis from one side
    const double offset = random.chance(0.4) ? 0 : std::max(0.0, to_axis + random.length(1e-3, 1));
    const Made made = over_outline(Kind::Revolve, offset, kind, params);
    if (made.known.outside != Exactness::Exact) return;
    ++exact;
    const BruteForceOutline outline(kind, params);
    const vm::VerifiedProgram program = plain_lowering(made.scene);
    for (int i = 0; i < 20; ++i) {
      const dvec3 p = random_point(random);
      check(vm::evaluate_distance(program, p, workspace), outline.distance({std::hypot(p.x, p.z) - offset, p.y}),
            made.known);
    }
  });
  CHECK(exact > 300);
}

}  // namespace fathom::test
