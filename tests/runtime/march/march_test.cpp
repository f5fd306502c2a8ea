// The marcher's guarantees for every ray. The hard cases, one by one, are in tests/catalogue/intersection_test.cpp.
// The truth is computed in long double from the marched rays themselves, whose coordinates are exact in float.
#include "runtime/march/march.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <glm/geometric.hpp>

#include "tests/runtime/rays.h"
#include "tests/runtime/scenes.h"
#include "tests/support/catch.h"

namespace fathom::runtime::march_test {
namespace {

void expect_accurate(const char* scene_text, const std::vector<Ray>& rays, const Truth& truth) {
  const auto scene = scene_of(scene_text);
  const MarchResult result = march(make_field(scene), rays);
  const Judgement judgement = judge(result, rays, truth);
  CHECK(judgement.false_hits == 0);
  CHECK(judgement.false_misses == 0);
  CHECK(judgement.invalid == 0);
  CHECK(result.counters.exhausted == 0);
  REQUIRE(judgement.errors.size() > rays.size() / 4);
  CHECK(judgement.p99() <= 5e-6);
  CHECK(judgement.worst() <= 1e-4);
}

TEST_CASE("march: distances to a box and a torus", "[march]") {
  Random random(2);
  std::vector<Ray> from_outside, at_torus;
  for (int i = 0; i < 20000; ++i) {
    const glm::dvec3 inner(random.uniform(-0.74, 0.74), random.uniform(-0.49, 0.49), random.uniform(-0.99, 0.99));
    const glm::dvec3 d = random.direction();
    from_outside.push_back({to_float(inner - 5.0 * d), to_float(d)});
  }
  for (int i = 0; i < 5000; ++i) at_torus.push_back(aimed(random, random.uniform(0, 1.4), 5));
  expect_accurate(kBox, from_outside, box_distance);
  expect_accurate(kTorus, at_torus, torus_distance);
}

TEST_CASE("march: an empty scene is missed, and a wide floor hides nothing that stands on it", "[march]") {
  const auto nothing = scene_of(R"("objects": [{"type": "intersection", "of": [{"type": "sphere", "radius": 1},
      {"type": "sphere", "radius": 1, "translate": [5, 0, 0]}]}])");
  const auto wide = scene_of(R"("objects": [{"type": "box", "half_size": [1000, 1, 1000], "translate": [0, -1, 0]},
                                            {"type": "sphere", "radius": 0.05, "translate": [0, 0.05, 0]}])");
  std::vector<Ray> rays;
  for (int i = 0; i < 2000; ++i) {
    const double slope = std::pow(10.0, -1 - 3 * i / 2000.0);  // rise over run of a ray towards the ball's centre
    rays.push_back({to_float({0, 0.05 + 3 * slope, 3}), to_float(glm::normalize(glm::dvec3(0, -slope, -1)))});
  }
  CHECK(march(make_field(nothing), rays).counters.hits == 0);
  const MarchResult result = march(make_field(wide), rays);
  for (const RayHit& ray_hit : result.ray_hits) {
    if (!(ray_hit.t < 3)) FAIL_CHECK("the ray of slope number " << ray_hit.id << " went through the ball");
  }
}

// Regression: every ray ended at 1e12, whatever far limit was asked for.
TEST_CASE("march: a floor of any size is met", "[march]") {
  for (const char* size : {"1", "1e6", "1e12", "1e15"}) {
    CAPTURE(size);
    const auto scene =
        scene_of(std::string(R"("camera": {"position": [0, 0, )") + size +
                 R"(]}, "objects": [{"type": "plane", "normal": [0, 1, 0], "offset": -)" + size + "}]");
    const std::vector<Ray> rays{{to_float({0, 0, 0}), to_float(glm::normalize(glm::dvec3(0, -3, -4)))}};
    const MarchResult result = march(make_field(scene), rays);
    REQUIRE(result.counters.hits == 1);
    CHECK(result.ray_hits[0].t == Approx(std::atof(size) / 0.6).epsilon(1e-6));
  }
}

// Regression: this close to a surface, many t round to the same point, and the field there is exactly 0. Brackets
// moved through these t in steps of a millionth of t.
TEST_CASE("march: a surface at a tiny t is found as soon as any other", "[march]") {
  const auto scene = scene_of(R"("objects": [{"type": "sphere", "radius": 0.5},
      {"type": "plane", "normal": [0, 1, 0], "offset": -0.5}])");
  Random random(3);
  std::vector<Ray> rays;
  for (int i = 0; i < 20000; ++i) {
    const double height = std::pow(10.0, random.uniform(-8, -4));
    const glm::dvec3 d = random.direction();
    rays.push_back({to_float({random.uniform(-2, 2), -0.5 + height, random.uniform(-2, 2)}), to_float(d)});
    const glm::dvec3 n = random.direction();
    rays.push_back({to_float((0.5 + height) * n), to_float(d)});
  }
  const MarchResult result = march(make_field(scene), rays);
  std::uint32_t most = 0;
  for (const RayHit& ray_hit : result.ray_hits) most = std::max(most, ray_hit.evaluations);
  CHECK(most < 1000);
  CHECK(result.counters.evaluations < 20 * rays.size());
}

TEST_CASE("march: the result of a ray depends on the ray alone", "[march]") {
  const auto scene = scene_of(R"("objects": [{"type": "torus", "major_radius": 1, "minor_radius": 0.25},
      {"type": "box", "half_size": [0.2, 0.4, 0.3], "translate": [0.4, 0.1, 0]},
      {"type": "sphere", "radius": 0.3}])");
  const Field field = make_field(scene);
  const std::vector<Ray> rays = rays_at_sphere(2000, 4);
  const MarchResult together = march(field, rays);
  for (std::size_t i = 0; i < rays.size(); i += 7) {
    const RayHit alone = march(field, std::span(rays).subspan(i, 1)).ray_hits[0];
    CHECK(alone.status == together.ray_hits[i].status);
    CHECK(alone.t == together.ray_hits[i].t);
  }
}

}  // namespace
}  // namespace fathom::runtime::march_test
