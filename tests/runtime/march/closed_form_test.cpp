// Entrances of rays into moved balls, boxes and others, into what they have in common, and into what is left of them,
// are where the field in double changes its sign, and a ray that misses by the formula has no hit.
#include "runtime/march/closed_form.h"

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "runtime/march/march.h"
#include "runtime/march/piece_scan.h"
#include "tests/support/catch.h"
#include "tests/support/compiled.h"
#include "tests/support/random/random_scene.h"
#include "tests/support/scaled_cases.h"

namespace fathom::closed_form_test {

namespace {

using namespace fathom;
using namespace fathom::runtime;

compiler::CompiledScene solid(const std::string& shape, test::Random& random) {
  compiler::CompileOptions options;
  options.pieces = true;
  options.origin = glm::dvec3(0);
  const std::string text = fmt::format(
      "fathom 1\nobject {}.scale({:.3f}).rotate([{:.1f}, {:.1f}, 7]).translate([{:.3f}, 0.2, {:.3f}])\n"
      "object mandelbulb().translate([99, 0, 0])\n",
      shape, random.uniform(0.3, 3), random.uniform(0, 90), random.uniform(0, 90), random.uniform(-2, 2),
      random.uniform(-2, 2));
  return test::compiled(text, options);
}

}  // namespace

TEST_CASE("closed forms: rays enter where the search in double says", "[march][pieces]") {
  // Hollow ones have rays within.
  const char* const shapes[] = {
      "sphere(0.7)",
      "box([0.5, 0.8, 0.2])",
      "cylinder(0.4, 0.9)",
      "plane([0.6, 0.8, 0], offset = 0.3)",
      "capsule(0.3, 0.5)",
      "round_box([0.5, 0.8, 0.3], 0.1)",
      "rounded_cylinder(0.5, 0.6, 0.15)",
      "ellipsoid([0.5, 0.9, 0.3])",
      "(box([0.7, 0.7, 0.7]) & sphere(0.8))",
      "(box([2, 1.5, 2]) - box([1.8, 1.3, 1.8]))",
      "(box([2, 1.5, 2]) - box([1.8, 1.3, 1.8]) - cylinder(0.6, 2) - box([3, 0.4, 0.5]))",
      "(sphere(1.8) - sphere(1.6) - capsule(0.5, 2) - plane([0, 0, 1], offset = -1))",
      "(cylinder(1.5, 0.5) - (sphere(0.5).translate([0.9, 0.3, 0]) + cylinder(0.3, 1).translate([-0.8, 0, 0])))"};
  int entered = 0, missed = 0, uncertain = 0, begun = 0;
  for (int seed = 0; seed < test::scaled_cases(104); ++seed) {
    test::Random random(static_cast<std::uint64_t>(seed));
    const compiler::CompiledScene scene = solid(shapes[static_cast<std::size_t>(seed) % std::size(shapes)], random);
    REQUIRE(scene.pieces.size() == 2);  // the fractal has no proved bound
    const std::vector<compiler::ClosedForm>& forms = scene.pieces[0].forms;
    REQUIRE_FALSE(forms.empty());
    const Field field = make_field(scene.pieces[0], 10, std::nullopt);
    const auto found = std::make_unique<Entrances>();
    std::vector<compiler::ClosedForm> alike;
    for (int i = 0; i < 3; ++i) alike.insert(alike.end(), forms.begin(), forms.end());
    std::vector<Ray> rays;
    for (std::uint32_t i = 0; i < 100; ++i) {
      rays.push_back({random.uniform(0, 5) * random.direction() + random.in_box(1), random.direction(), 50, 0});
      found->push(rays.back().origin, rays.back().direction, i % 3 * static_cast<std::uint32_t>(forms.size()));
    }
    // Forms with numbers of their own, and those of one piece.
    find_entrances(alike, forms.size(), seed % 2 == 0, *found);
    const std::vector<RayHit> truths = march(field, rays, {.method = Method::Certified}).ray_hits;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const RayHit& truth = truths[i];
      const Meeting meeting = found->meeting_of(i);
      const double t = found->t[i];
      const bool hit = truth.status == RayHit::Status::Hit;
      INFO(shapes[static_cast<std::size_t>(seed) % std::size(shapes)]
           << ", seed " << seed << ", ray " << i << ": " << static_cast<int>(meeting) << " at " << t << ", in truth "
           << hit << " at " << truth.t);
      if (truth.side < 0) {
        CHECK(meeting == Meeting::Uncertain);
        continue;
      }
      ++begun;
      if (meeting == Meeting::Enters && t < 50) {
        ++entered;
        CHECK(hit);
        CHECK(std::abs(t - truth.t) <= found->slack[i] + truth.width);
      }
      if (meeting == Meeting::Misses) CHECK_FALSE(hit);
      missed += meeting == Meeting::Misses;
      uncertain += meeting == Meeting::Uncertain;
    }
  }
  CAPTURE(entered, missed, uncertain, begun);
  CHECK(entered > begun / 8);
  CHECK(missed > begun / 8);
  CHECK(uncertain < begun / 32);  // among them those that pass rounded edges
}

// A ray is told the first piece that a formula is certain of, and every other that it may enter before.
TEST_CASE("closed forms: a scan finds what each piece alone says", "[march][pieces]") {
  compiler::CompileOptions options;
  options.pieces = true;
  const compiler::CompiledScene scene = test::compiled(
      "fathom 1\nobject sphere(0.7)\nobject box([0.5, 0.8, 0.2]).rotate([20, 30, 0]).translate([2, 0, 0])\n"
      "object torus(0.8, 0.2).translate([-2, 0, 0])\nobject plane([0, 1, 0], offset = -1)\n"
      "object box([0.6, 0.6, 0.6]).translate([0, 0, 2]) - sphere(0.7).translate([0, 0, 2])\n"
      "object mandelbulb().translate([99, 0, 0])\n",
      options);
  Field field = make_field(scene);
  add_pieces(field, scene, extent_of(scene), std::nullopt, false);
  REQUIRE(field.pieces);
  const Pieces& pieces = *field.pieces;
  PieceScan scan(pieces);
  auto rays = std::make_unique<RayBlock>();
  test::Random random(1);
  while (rays->count < 1000) {
    const Ray ray{4.0 * random.direction() + glm::dvec3(0, 3.5, 0),
                  random.direction(),
                  40,
                  1,
                  -1,
                  0,
                  rays->count % 3 == 0 ? 1 : kNoPiece};
    if (!find_solid(field, ray.origin, *std::make_unique<RealScratch>())) rays->push(0, ray);
  }
  clip(*rays, 0, field.bound, field.far);
  vm::Workspace workspace;
  scan.scan(*rays, 0, workspace);
  int rooted = 0, alone = 0;
  for (std::size_t i = 0; i < rays->count; ++i) {
    if (rays->clip_result(i) != ClipResult::Within) continue;
    const PieceScan::Found& found = scan.found(i);
    const Ray ray{rays->origin_of(i), rays->direction_of(i), rays->length[i], 1};
    for (std::uint32_t k = 0; k < pieces.fields.size(); ++k) {
      INFO("ray " << i << ", piece " << k);
      if (k == rays->leaves[i]) {
        CHECK((found.piece != k && (found.others >> k & 1) == 0));
        continue;
      }
      const RayHit truth = march(pieces.fields[k], {&ray, 1}, {.method = Method::Certified}).ray_hits[0];
      const bool hit = truth.status == RayHit::Status::Hit;
      if (found.piece == k) {
        CHECK(hit);
        CHECK(std::abs(found.t - truth.t) <= 1e-5 * std::max(1.0, truth.t));
      } else if (hit && (found.piece == kNoPiece || truth.t < found.t)) {
        CHECK((found.others >> k & 1) == 1);
      }
    }
    rooted += found.piece != kNoPiece;
    alone += found.others == 0;
  }
  CHECK(rooted > 300);
  CHECK(alone > 300);
}

}  // namespace fathom::closed_form_test
