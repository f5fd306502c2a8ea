// Entrances of rays into moved balls, boxes, cylinders and half-spaces are where the field in double changes its
// sign, and a ray that misses by the formula has no hit.
#include "runtime/march/closed_form.h"

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "runtime/march/march.h"
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
  const std::string text =
      fmt::format("fathom 1\nobject {}.scale({:.3f}).rotate([{:.1f}, {:.1f}, 7]).translate([{:.3f}, 0.2, {:.3f}])\n",
                  shape, random.uniform(0.3, 3), random.uniform(0, 90), random.uniform(0, 90), random.uniform(-2, 2),
                  random.uniform(-2, 2));
  return test::compiled(text, options);
}

}  // namespace

TEST_CASE("closed forms: rays enter where the search in double says", "[march][pieces]") {
  int entered = 0, missed = 0, uncertain = 0;
  for (int seed = 0; seed < test::scaled_cases(64); ++seed) {
    test::Random random(static_cast<std::uint64_t>(seed));
    const char* const shapes[] = {"sphere(0.7)", "box([0.5, 0.8, 0.2])", "cylinder(0.4, 0.9)",
                                  "plane([0.6, 0.8, 0], offset = 0.3)"};
    const compiler::CompiledScene scene = solid(shapes[seed % 4], random);
    REQUIRE(scene.pieces.size() == 1);
    const compiler::ClosedForm& form = scene.pieces[0].form;
    REQUIRE(form.shape != compiler::ClosedForm::Shape::None);
    const Field field = make_field(scene);
    for (int i = 0; i < 100; ++i) {
      const Ray ray{4.0 * random.direction() + random.in_box(1), random.direction(), 50, 0};
      const RayHit truth = march(field, {&ray, 1}, {.method = Method::Certified}).ray_hits[0];
      const Entrance found = find_entrance(form, ray.origin, ray.direction);
      const bool hit = truth.status == RayHit::Status::Hit;
      INFO("seed " << seed << ", ray " << i << ": " << static_cast<int>(found.meeting) << " at " << found.t
                   << ", in truth " << hit << " at " << truth.t);
      if (truth.side < 0) {
        CHECK(found.meeting == Meeting::Uncertain);
        continue;
      }
      if (found.meeting == Meeting::Enters && found.t < 50) {
        ++entered;
        CHECK(hit);
        CHECK(std::abs(found.t - truth.t) <= found.slack + truth.width);
      }
      if (found.meeting == Meeting::Misses) CHECK_FALSE(hit);
      missed += found.meeting == Meeting::Misses;
      uncertain += found.meeting == Meeting::Uncertain;
    }
  }
  CAPTURE(entered, missed, uncertain);
  CHECK(entered > test::scaled_cases(400));
  CHECK(missed > test::scaled_cases(400));
  CHECK(uncertain < test::scaled_cases(40));
}

}  // namespace fathom::closed_form_test
