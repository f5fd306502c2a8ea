// Tests of evaluate_place: the point in the coordinates of the node that carries the surface's paint.
#include <cmath>
#include <glm/geometric.hpp>
#include <string>

#include "compiler/lower/fuse.h"
#include "compiler/lower/lower.h"
#include "compiler/passes/passes.h"
#include "compiler/shapes/print_graph.h"
#include "tests/support/catch.h"
#include "tests/support/compiled.h"
#include "tests/support/judge/judge.h"
#include "tests/support/plain_lowering.h"
#include "tests/support/random/random_scene.h"
#include "tests/support/scaled_cases.h"
#include "vm/interpret/evaluate.h"

namespace fathom::test::place_test {
namespace {

using compiler::Scene;
using glm::dvec3;

// Levelled, as the first pass does: the distances of the program and of the judge are the same.
Scene painted_scene(int seed) {
  Random random(seed);
  GraphOptions options;
  options.depth = 2 + seed % 4;
  return compiler::normalise(random_scene(random, options));
}

// Compiles the surface program: runs all passes except the one that removes paint.
vm::VerifiedProgram surface_program(Scene scene) {
  for (const compiler::Pass& pass : compiler::passes()) {
    if (pass.run != compiler::strip) scene = pass.run(scene);
  }
  return verified(compiler::fuse(*compiler::lower(scene, compiler::Source{}, 100000)));
}

// Distance between the program's place and the judge's, relative to the size of the coordinates.
double error_of(const vm::SurfacePlace& found, const Verdict& verdict) {
  return glm::length(found.place - verdict.place) / std::max(1.0, glm::length(verdict.place));
}

}  // namespace

TEST_CASE("place: of random graphs it is the point at the innermost paint of what wins", "[interpret][place]") {
  vm::Workspace workspace;
  int moved = 0;
  for (int seed = 0; seed < scaled_cases(600); ++seed) {
    const Scene scene = painted_scene(seed);
    const vm::VerifiedProgram program = surface_program(scene);
    INFO("seed " << seed << '\n' << compiler::print_graph(scene, compiler::Source{}));
    Random random(seed);
    for (int i = 0; i < 30; ++i) {
      const dvec3 p = random.in_box(3);
      const Verdict verdict = judge(scene.graph, scene.root, p);
      // Culling may remove the nearest part at a point inside a solid, because only the surface matters.
      if (!(verdict.margin > 1e-8) || verdict.surface == 0 || verdict.distance < 0) continue;
      INFO("at " << p.x << ' ' << p.y << ' ' << p.z);
      const vm::SurfacePlace found = vm::evaluate_place(program, p, workspace);
      if (found.surface != verdict.surface) {  // the judge's surface was culled: the remaining ones are farther
        CHECK(vm::evaluate_distance(program, p, workspace) >= verdict.distance - 1e-9);
        continue;
      }
      CHECK(error_of(found, verdict) <= 1e-9);
      moved += glm::length(verdict.place - p) > 1e-3;
    }
  }
  CHECK(moved > scaled_cases(600));
}

TEST_CASE("place: it is of the surface that the distance is of", "[interpret][place]") {
  vm::Workspace workspace;
  for (int seed = 0; seed < scaled_cases(300); ++seed) {
    const vm::VerifiedProgram program = surface_program(painted_scene(seed));
    Random random(seed);
    for (int i = 0; i < 30; ++i) {
      const dvec3 p = random.in_box(3);
      INFO("seed " << seed << ", at " << p.x << ' ' << p.y << ' ' << p.z);
      CHECK(vm::evaluate_place(program, p, workspace).surface == vm::evaluate_surface(program, p, workspace).surface);
    }
  }
}

TEST_CASE("place: without tags it is the point", "[interpret][place]") {
  vm::Workspace workspace;
  const auto scene = test::compiled_objects(R"({"type": "sphere", "radius": 1, "translate": [3, 0, 0]})");
  const vm::SurfacePlace found = vm::evaluate_place(scene.surface, {2, 1, 0}, workspace);
  CHECK(found.surface == 0);
  CHECK(found.place == dvec3(2, 1, 0));
}

TEST_CASE("place: of two equal tags at one distance the first counts", "[interpret][place]") {
  vm::Workspace workspace;
  const auto scene = test::compiled(R"({"version": 1,
      "materials": {"m": {"type": "diffuse", "space": "object", "color": {"pattern": "checker", "a": 0, "b": 1}}},
      "objects": [{"type": "union", "of": [{"type": "sphere", "radius": 1, "translate": [-2, 0, 0], "material": "m"},
        {"type": "sphere", "radius": 1, "translate": [2, 0, 0], "material": "m"}]}]})");
  CHECK(scene.surfaces.size() == 1);
  CHECK(vm::evaluate_place(scene.surface, {0, 0, 0}, workspace).place == dvec3(2, 0, 0));
}

TEST_CASE("shares: two bodies of one surface have each its own share and place", "[interpret][place]") {
  vm::Workspace workspace;
  const auto scene = test::compiled(R"({"version": 1,
      "materials": {"m": {"type": "diffuse", "space": "object", "color": {"pattern": "checker", "a": 0, "b": 1}}},
      "objects": [{"type": "smooth_union", "k": 0.5, "of": [
        {"type": "sphere", "radius": 1, "material": "m"},
        {"type": "sphere", "radius": 1, "translate": [1.5, 0, 0], "material": "m"}]}]})");
  CHECK(scene.surfaces[0].mixed);
  const vm::SurfaceShares shares = vm::evaluate_placed_shares(scene.surface, {0.75, 0.7, 0}, workspace);
  REQUIRE(shares.count == 2);
  CHECK(shares.all[0].weight == Approx(0.5));
  CHECK(shares.all[0].place == dvec3(0.75, 0.7, 0));
  CHECK(shares.all[1].place == dvec3(-0.75, 0.7, 0));
  CHECK(vm::evaluate_shares(scene.surface, {0.75, 0.7, 0}, workspace).count == 1);
}

}  // namespace fathom::test::place_test
