// Solids made of other solids, and solids whose fields are not exact: the Menger sponge against its cubes, Julia sets
// against their orbits.
#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "compiler/shapes/bounds.h"
#include "tests/compiler/shapes/primitives.h"
#include "tests/support/catch.h"
#include "tests/support/judge/judge.h"
#include "tests/support/plain_lowering.h"

namespace fathom::test::solids_test {
namespace {

using compiler::Kind;
using glm::dvec3;

// Distance to the nearest cube that remains of a cube of this half size after removing `levels` levels of holes.
double distance_to_cubes(dvec3 p, dvec3 centre, double half, int levels) {
  const dvec3 beyond = glm::max(glm::abs(p - centre) - half, 0.0);
  if (levels == 0) return glm::length(beyond);
  double nearest = 1e9;
  for (int cell = 0; cell < 27; ++cell) {
    const dvec3 at(cell % 3 - 1, cell / 3 % 3 - 1, cell / 9 - 1);
    if (glm::dot(at, at) < 2) continue;  // the centre cell and its six neighbours
    nearest = std::min(nearest, distance_to_cubes(p, centre + at * (2 * half / 3), half / 3, levels - 1));
  }
  return nearest;
}

}  // namespace

TEST_CASE("solids composed of others have the judge's distance, a box and a constant that hold", "[shapes]") {
  vm::Workspace workspace;
  for (const compiler::NodeSpec& row : compiler::node_table()) {
    if (row.expand == nullptr) continue;
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      Random random(seed);
      const Sample s = sample(row.kind, random);
      INFO(s.name << ", seed " << seed);
      const compiler::NodeFacts known = compiler::analyse(s.scene.graph)[s.scene.root];
      const vm::VerifiedProgram program = plain_lowering(s.scene);
      for (int i = 0; i < 50; ++i) {
        const dvec3 p = random_point(random), q = p + random.direction() * random.length(1e-3, 2);
        const double d = vm::evaluate_distance(program, p, workspace);
        CHECK(std::abs(d - judge_distance(s.scene.graph, s.scene.root, p)) <= 1e-13 * scale_of(p));
        CHECK((known.box.contains(p) || d > -1e-14));
        CHECK(std::abs(d - vm::evaluate_distance(program, q, workspace)) <=
              known.lipschitz * glm::length(p - q) + 1e-12 * scale_of(p));
      }
    }
  }
}

TEST_CASE("a Menger sponge is what its cubes are, and its field never more than their distance", "[shapes]") {
  vm::Workspace workspace;
  for (int levels = 1; levels <= 3; ++levels) {
    const vm::VerifiedProgram sponge = primitive_program(Kind::MengerSponge, {0.75, double(levels)});
    Random random(static_cast<std::uint64_t>(levels));
    for (int i = 0; i < 1000; ++i) {
      const dvec3 p = random.in_box(i % 2 ? 0.8 : 2.0);
      const double found = vm::evaluate_distance(sponge, p, workspace);
      const double truth = distance_to_cubes(p, dvec3(0), 0.75, levels);
      INFO(levels << " levels, at " << p.x << ' ' << p.y << ' ' << p.z);
      CHECK(found <= truth + 1e-14);
      if (truth > 1e-12) CHECK(found > 0);
    }
  }
}

// Compares the ellipsoid with random points of its surface.
TEST_CASE("an ellipsoid's distance has the right sign and is never too much", "[shapes]") {
  vm::Workspace workspace;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    Random random(seed);
    const std::vector<double> params = random_params(Kind::Ellipsoid, random);
    const dvec3 radii(params[0], params[1], params[2]);
    const vm::VerifiedProgram program = primitive_program(Kind::Ellipsoid, params);
    for (int i = 0; i < 100; ++i) {
      const dvec3 p = random.in_box(2);
      const double d = vm::evaluate_distance(program, p, workspace);
      CHECK((d < 0) == (glm::length(p / radii) < 1));
      for (int j = 0; j < 20; ++j) CHECK(std::abs(d) <= glm::length(p - random.direction() * radii) + 1e-12);
    }
  }
}

// All points within minor_radius of a racetrack: two segments along y and two half circles.
TEST_CASE("a link is all within its radius of a racetrack", "[shapes]") {
  vm::Workspace workspace;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    Random random(seed);
    const std::vector<double> k = random_params(Kind::Link, random);
    const vm::VerifiedProgram program = primitive_program(Kind::Link, k);
    for (int i = 0; i < 100; ++i) {
      const dvec3 p = random.in_box(2);
      const double y = p.y - std::clamp(p.y, -k[2], k[2]);
      const double in_plane = y == 0 ? std::abs(std::abs(p.x) - k[0]) : std::abs(std::hypot(p.x, y) - k[0]);
      const double truth = std::hypot(in_plane, p.z) - k[1];
      CHECK(std::abs(vm::evaluate_distance(program, p, workspace) - truth) <= 1e-14 * 4);
    }
  }
}

// In the half-plane of the distance from the axis and y, the wall is a rectangle.
TEST_CASE("a tube is as far as its wall", "[shapes]") {
  vm::Workspace workspace;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    Random random(seed);
    const std::vector<double> k = random_params(Kind::Tube, random);
    const compiler::Scene scene = single(Kind::Tube, k);
    const compiler::NodeFacts known = compiler::analyse(scene.graph)[scene.root];
    CHECK((known.outside == compiler::Exactness::Exact && known.inside == compiler::Exactness::Exact));
    const vm::VerifiedProgram program = plain_lowering(scene);
    for (int i = 0; i < 100; ++i) {
      const dvec3 p = random.in_box(2);
      const double beside = std::abs(std::hypot(p.x, p.z) - k[0]) - k[2], above = std::abs(p.y) - k[1];
      const double outside = std::hypot(std::max(beside, 0.0), std::max(above, 0.0));
      const double truth = outside > 0 ? outside : std::max(beside, above);
      CHECK(std::abs(vm::evaluate_distance(program, p, workspace) - truth) <= 1e-14 * 4);
    }
  }
}

// A point is inside if its orbit stays in the ball outside which every orbit escapes.
TEST_CASE("a Julia set is negative where orbits stay, positive where they leave, and never NaN", "[shapes]") {
  vm::Workspace workspace;
  int inside = 0, outside = 0;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    Random random(seed);
    std::vector<double> params = random_params(Kind::Julia, random);
    params[6] = 0;
    const vm::VerifiedProgram program = primitive_program(Kind::Julia, params);
    const double radius = compiler::spec(Kind::Julia).bound(params).hi.x;
    for (int i = 0; i < 100; ++i) {
      const dvec3 p = i == 0 ? dvec3(0) : random.in_box(i % 10 == 0 ? 100.0 : 1.5);
      double q[4] = {p.x, p.y, p.z, 0};
      const auto size = [&] { return std::hypot(std::hypot(q[0], q[1]), std::hypot(q[2], q[3])); };
      for (int n = 0; n < static_cast<int>(params[4]) && size() < params[5]; ++n) {
        const double twice = 2 * q[0];
        q[0] = q[0] * q[0] - q[1] * q[1] - q[2] * q[2] - q[3] * q[3] + params[0];
        for (int k = 1; k < 4; ++k) q[k] = twice * q[k] + params[static_cast<std::size_t>(k)];
      }
      const vm::SurfaceValue v = vm::evaluate_surface(program, p, workspace);
      INFO("seed " << seed << ", at " << p.x << ' ' << p.y << ' ' << p.z);
      CHECK(std::isfinite(v.distance));
      CHECK(std::isfinite(glm::length(v.gradient)));
      CHECK(v.distance >= glm::length(p) - radius - 1e-12);
      if (std::abs(size() - radius) < 1e-9) continue;
      CHECK((v.distance < 0) == (size() < radius));
      ++(size() < radius ? inside : outside);
    }
  }
  CHECK(inside > 500);
  CHECK(outside > 500);
}

}  // namespace fathom::test::solids_test
