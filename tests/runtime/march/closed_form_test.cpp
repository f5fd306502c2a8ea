// Entrances of rays into moved balls, boxes, cylinders and half-spaces are where the field in double changes its
// sign, and a ray that misses by the formula has no hit.
#include "runtime/march/closed_form.h"

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

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
  int entered = 0, missed = 0, uncertain = 0;
  for (int seed = 0; seed < test::scaled_cases(64); ++seed) {
    test::Random random(static_cast<std::uint64_t>(seed));
    const char* const shapes[] = {"sphere(0.7)", "box([0.5, 0.8, 0.2])", "cylinder(0.4, 0.9)",
                                  "plane([0.6, 0.8, 0], offset = 0.3)"};
    const compiler::CompiledScene scene = solid(shapes[seed % 4], random);
    REQUIRE(scene.pieces.size() == 2);  // the fractal has no proved bound
    const compiler::ClosedForm& form = scene.pieces[0].form;
    REQUIRE(form.shape != compiler::ClosedForm::Shape::None);
    const Field field = make_field(scene.pieces[0], 10, std::nullopt);
    const auto found = std::make_unique<Entrances>();
    std::vector<Ray> rays;
    for (int i = 0; i < 100; ++i) {
      rays.push_back({4.0 * random.direction() + random.in_box(1), random.direction(), 50, 0});
      found->push(rays.back().origin, rays.back().direction, i % 3);
    }
    // Forms with numbers of their own, and one form.
    const compiler::ClosedForm alike[] = {form, form, form};
    find_entrances(alike, seed % 8 < 4, *found);
    const std::vector<RayHit> truths = march(field, rays, {.method = Method::Certified}).ray_hits;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const RayHit& truth = truths[i];
      const Meeting meeting = found->meeting_of(i);
      const double t = found->t[i];
      const bool hit = truth.status == RayHit::Status::Hit;
      INFO("seed " << seed << ", ray " << i << ": " << static_cast<int>(meeting) << " at " << t << ", in truth "
                   << hit << " at " << truth.t);
      if (truth.side < 0) {
        CHECK(meeting == Meeting::Uncertain);
        continue;
      }
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
  CAPTURE(entered, missed, uncertain);
  CHECK(entered > test::scaled_cases(400));
  CHECK(missed > test::scaled_cases(400));
  CHECK(uncertain < test::scaled_cases(40));
}

}  // namespace fathom::closed_form_test
