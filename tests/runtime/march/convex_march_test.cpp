// Rays that use convexity radii (Field::convex, Ray::clear) against the search in double, which uses none: no hit is
// lost, no ray hits the surface it left, and rays take fewer evaluations.
#include <fmt/format.h>

#include <cmath>
#include <string>
#include <vector>

#include "runtime/march/march.h"
#include "runtime/measure/ray_sets.h"
#include "tests/catalogue/departures.h"
#include "tests/support/catch.h"
#include "tests/support/compiled.h"
#include "tests/support/random/random_scene.h"
#include "tests/support/scaled_cases.h"

namespace fathom::convex_march_test {

namespace {

using namespace fathom;
using namespace fathom::runtime;

// Convex and other shapes, far and near, cut, blended, rounded, scaled and mirrored, on a ground plane.
std::string scene(std::uint64_t seed) {
  test::Random random(seed);
  static const char* kShapes[] = {"\"sphere\", \"radius\": {0:.3f}",
                                  "\"box\", \"half_size\": [{0:.3f}, {1:.3f}, {2:.3f}]",
                                  "\"cylinder\", \"radius\": {0:.3f}, \"half_height\": {1:.3f}",
                                  "\"capsule\", \"radius\": {0:.3f}, \"half_height\": {1:.3f}",
                                  "\"octahedron\", \"radius\": {0:.3f}",
                                  "\"torus\", \"major_radius\": {1:.3f}, \"minor_radius\": {2:.3f}"};
  const auto shape = [&] {
    const double r = random.uniform(0.1, 0.6);
    return fmt::format("{{\"type\": {}, \"translate\": [{:.3f}, {:.3f}, {:.3f}], \"rotate\": [{}, {}, 0]}}",
                       fmt::format(fmt::runtime(kShapes[random.below(6)]), r, 1.3 * r, 0.5 * r),
                       random.uniform(-2, 2), random.uniform(0, 1.5), random.uniform(-2, 2), random.below(90),
                       random.below(90));
  };
  static const char* kFusedMin[] = {"{0}",
                                    "{{\"type\": \"subtraction\", \"of\": [{0}, {1}]}}",
                                    "{{\"type\": \"intersection\", \"of\": [{0}, {1}]}}",
                                    "{{\"type\": \"smooth_union\", \"k\": 0.2, \"of\": [{0}, {1}]}}",
                                    "{{\"type\": \"smooth_subtraction\", \"k\": 0.1, \"of\": [{0}, {1}]}}",
                                    "{{\"type\": \"round\", \"radius\": 0.05, \"of\": {0}}}",
                                    "{{\"type\": \"onion\", \"thickness\": 0.03, \"of\": {0}}}",
                                    "{{\"type\": \"mirror\", \"normal\": [1, 0, 0], \"of\": {0}}}",
                                    "{{\"type\": \"union\", \"of\": [{0}, {1}], \"scale\": 0.7}}"};
  std::string objects = "{\"type\": \"plane\", \"normal\": [0, 1, 0], \"offset\": 0}";
  for (int i = 0; i < 8; ++i)
    objects += ",\n" + fmt::format(fmt::runtime(kFusedMin[random.below(9)]), shape(), shape());
  return "{\"version\": 1, \"camera\": {\"position\": [4, 3, 5], \"target\": [0, 0.5, 0]}, \"objects\": [" + objects +
         "]}";
}

struct Tally {
  int rays = 0, wrong = 0, off = 0;
  std::uint64_t evaluations = 0;
};

void compare(const std::vector<RayHit>& found, const std::vector<RayHit>& exact, Tally& tally) {
  for (std::size_t i = 0; i < found.size(); ++i) {
    ++tally.rays;
    tally.evaluations += found[i].evaluations;
    const bool hit = found[i].status == RayHit::Status::Hit, met = exact[i].status == RayHit::Status::Hit;
    tally.wrong += hit != met;
    tally.off += hit && met && std::abs(found[i].t - exact[i].t) > 1e-4;
  }
}

}  // namespace

TEST_CASE("convex fields: rays end where the search in double ends them, sooner", "[march][convexity]") {
  Tally led, plain;
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    const compiler::CompiledScene compiled = test::compiled(scene(seed));
    Field field = make_field(compiled);
    for (const RaySet& set : make_ray_sets(compiled, field, test::scaled_cases(240), seed)) {
      const std::vector<RayHit> exact = march(field, set.rays, {.method = Method::Certified}).ray_hits;
      field.convex = true;
      compare(march(field, set.rays).ray_hits, exact, led);
      field.convex = false;
      compare(march(field, set.rays).ray_hits, exact, plain);
    }
  }
  CAPTURE(led.rays, led.wrong, plain.wrong, led.off, plain.off, led.evaluations, plain.evaluations);
  CHECK(led.rays > test::scaled_cases(6000));
  CHECK(led.wrong <= plain.wrong);
  CHECK(led.off <= plain.off);
  CHECK(led.evaluations < 0.85 * static_cast<double>(plain.evaluations));
}

TEST_CASE("convex fields: what is clear of a place that was hit is", "[march][convexity]") {
  Tally skipping, plain;
  int clear = 0;
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    const compiler::CompiledScene compiled = test::compiled(scene(seed));
    const Field field = make_field(compiled);
    const catalogue::Places places =
        catalogue::places(compiled, make_ray_sets(compiled, field, test::scaled_cases(480), seed)[0].rays);
    test::Random random(seed);
    std::vector<Ray> rays, without;
    for (std::size_t i = 0; i < places.hits.size(); ++i) {
      const glm::dvec3 normal(places.points[i].normal), direction = random.direction();
      // Every third ray is nearly along the surface.
      const glm::dvec3 aside = direction - (1 - 0.02 * (i % 3 == 0)) * glm::dot(direction, normal) * normal;
      const glm::dvec3 away = i % 3 == 0 ? aside : direction;
      const double side = glm::dot(away, normal) < 0 ? -1 : 1;
      const glm::dvec3 up = away + (side - 1) * glm::dot(away, normal) * normal;
      rays.push_back(spawn_ray(places.hits[i], places.points[i], glm::normalize(up), false));
      clear += rays.back().clear > 0;
      without.push_back(rays.back());
      without.back().clear = 0;
    }
    const std::vector<RayHit> exact = march(field, without, {.method = Method::Certified}).ray_hits;
    compare(march(field, rays).ray_hits, exact, skipping);
    compare(march(field, without).ray_hits, exact, plain);
  }
  CAPTURE(skipping.rays, clear, skipping.wrong, plain.wrong, skipping.off, plain.off, skipping.evaluations,
          plain.evaluations);
  CHECK(clear > 0.5 * skipping.rays);
  CHECK(skipping.wrong <= plain.wrong);
  CHECK(skipping.off <= plain.off);
  CHECK(skipping.evaluations < 0.95 * static_cast<double>(plain.evaluations));
}

}  // namespace fathom::convex_march_test
