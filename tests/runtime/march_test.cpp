// Rays against surfaces whose distances are known in closed form. Truth is computed in long double from the very rays
// that are marched, whose numbers are exact in float.
#include "runtime/march.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <glm/geometric.hpp>

#include "runtime/certify.h"
#include "tests/runtime/rays.h"
#include "tests/runtime/scenes.h"

namespace fathom::runtime {
namespace {

const char* const kSphere = R"("objects": [{"type": "sphere", "radius": 1}])";
const char* const kBox = R"("objects": [{"type": "box", "half_size": [0.75, 0.5, 1]}])";
const char* const kPlane = R"("objects": [{"type": "plane", "normal": [0, 1, 0]}])";
const char* const kTorus = R"("objects": [{"type": "torus", "major_radius": 1, "minor_radius": 0.25}])";

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

std::vector<Ray> rays_at_sphere(int count, double away) {
  Random random(1);
  std::vector<Ray> rays;
  for (int i = 0; i < count; ++i) rays.push_back(aimed(random, std::sqrt(random.uniform(0, 1)), away));
  return rays;
}

TEST_CASE("march: distances to a sphere, by area", "[march]") {
  expect_accurate(kSphere, rays_at_sphere(40000, 5), sphere_distance);
}

TEST_CASE("march: distances to a sphere from a hundred thousand units away", "[march]") {
  expect_accurate(kSphere, rays_at_sphere(20000, 1e5), sphere_distance);
}

TEST_CASE("march: distances to a box and a torus, from outside and from within", "[march]") {
  Random random(2);
  std::vector<Ray> from_outside, from_within, at_torus;
  for (int i = 0; i < 20000; ++i) {
    const glm::dvec3 inner(random.uniform(-0.74, 0.74), random.uniform(-0.49, 0.49), random.uniform(-0.99, 0.99));
    const glm::dvec3 d = random.direction();
    from_outside.push_back({to_float(inner - 5.0 * d), to_float(d)});
    from_within.push_back({to_float(inner), to_float(d)});
  }
  for (int i = 0; i < 5000; ++i) at_torus.push_back(aimed(random, random.uniform(0, 1.4), 5));
  expect_accurate(kBox, from_outside, box_distance);
  expect_accurate(kBox, from_within, box_distance);
  expect_accurate(kTorus, at_torus, torus_distance);
}

TEST_CASE("march: a ray inside a sphere finds the way out", "[march]") {
  Random random(3);
  std::vector<Ray> rays;
  for (int i = 0; i < 20000; ++i) rays.push_back(aimed(random, random.uniform(0, 0.999), 0));
  expect_accurate(kSphere, rays, sphere_distance);
  const auto scene = scene_of(kSphere);
  CHECK(march(make_field(scene), std::span(rays).first(1)).arrivals[0].side == -1);
}

TEST_CASE("march: rays that graze a sphere hit it, and near misses miss", "[march]") {
  Random random(4);
  std::vector<Ray> grazing, missing;
  for (int i = 0; i < 4000; ++i) {
    const double gap = std::pow(10.0, random.uniform(-6, -2));
    grazing.push_back(aimed(random, 1 - gap, 5));
    missing.push_back(aimed(random, 1 + gap, 5));
  }
  const auto scene = scene_of(kSphere);
  const MarchResult hits = march(make_field(scene), grazing), misses = march(make_field(scene), missing);
  const Judgement judgement = judge(hits, grazing, sphere_distance);
  CHECK(judgement.false_misses == 0);
  CHECK(judgement.p99() <= 2e-4);
  CHECK(judge(misses, missing, sphere_distance).false_hits == 0);
  CHECK(hits.counters.exhausted + misses.counters.exhausted == 0);
}

TEST_CASE("march: planes at grazing angles", "[march]") {
  const auto scene = scene_of(kPlane);
  for (const double degrees : {30.0, 10.0, 3.0, 1.0, 0.3, 0.1, 0.01}) {
    Random random(5);
    std::vector<Ray> rays;
    for (int i = 0; i < 200; ++i) {
      const double angle = degrees * M_PI / 180, turn = random.uniform(0, 2 * M_PI);
      rays.push_back(
          {to_float({0, random.uniform(0.5, 1), 0}),
           to_float({std::cos(angle) * std::cos(turn), -std::sin(angle), std::cos(angle) * std::sin(turn)})});
    }
    const MarchResult result = march(make_field(scene), rays);
    double worst = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      REQUIRE(result.arrivals[i].status == Arrival::Status::Hit);
      worst = std::max(worst, static_cast<double>(std::abs(result.arrivals[i].t / plane_distance(rays[i]) - 1)));
    }
    INFO(degrees << " degrees");
    CHECK(worst <= 1e-5);
    CHECK(result.counters.exhausted == 0);
  }
}

TEST_CASE("march: a ray along a plane or through a slit goes on to its end", "[march]") {
  const auto floor = scene_of(kPlane);
  const auto slit = scene_of(R"("objects": [{"type": "box", "half_size": [20, 1, 20], "translate": [0, -1.005, 0]},
                                            {"type": "box", "half_size": [20, 1, 20], "translate": [0, 1.005, 0]}])");
  const Ray along{{0, 2e-3, 0}, {1, 0, 0}, 30};
  CHECK(march(make_field(floor), std::span(&along, 1)).arrivals[0].status == Arrival::Status::Miss);
  CHECK(march(make_field(slit), std::span(&along, 1)).arrivals[0].status == Arrival::Status::Miss);
}

TEST_CASE("march: thin plates are hit on the near side", "[march]") {
  for (const double half : {1e-2, 1e-3, 1e-4, 1e-5, 4e-6}) {
    const std::string text =
        R"("objects": [{"type": "box", "half_size": [1, )" + std::to_string(half * 1e6) + R"(e-6, 1]}])";
    const auto scene = scene_of(text);
    Random random(6);
    std::vector<Ray> rays;
    while (rays.size() < 5000) {
      const glm::dvec3 d = random.direction(), through(random.uniform(-0.7, 0.7), 0, random.uniform(-0.7, 0.7));
      if (std::abs(d.y) > 0.1) rays.push_back({to_float(through - 5.0 * d), to_float(d)});
    }
    const Judgement judgement = judge(march(make_field(scene), rays), rays, [&](const Ray& ray) {
      const Real side = ray.origin.y > 0 ? 1 : -1;
      return (side * static_cast<Real>(static_cast<float>(half)) - ray.origin.y) / ray.direction.y;
    });
    INFO(half);
    CHECK(judgement.false_misses == 0);
    CHECK(judgement.p99() <= 5e-6);
    CHECK(judgement.worst() <= 2e-4);  // the far side is 2 half / |d.y| away
  }
}

TEST_CASE("march: rays that leave a convex body never meet it again", "[march]") {
  Random random(7);
  for (const char* text : {kSphere, kBox, kPlane}) {
    const auto scene = scene_of(text);
    std::vector<Ray> rays;
    for (int i = 0; i < 100000; ++i) {
      glm::dvec3 n = random.direction(), at = n;
      if (text == kBox) {
        n = {0, 0, n.z < 0 ? -1 : 1};
        at = {random.uniform(-0.75, 0.75), random.uniform(-0.5, 0.5), n.z};
      } else if (text == kPlane) {
        n = {0, 1, 0};
        at = {random.uniform(-1, 1), 0, random.uniform(-1, 1)};
      }
      glm::dvec3 d = random.direction();
      if (glm::dot(d, n) < 0) d = -d;
      Ray ray{to_float(at) + 16.0 * static_cast<double>(kDistanceError) * n, d};
      ray.side = 1;
      ray.slope = static_cast<float>(glm::dot(d, n));
      rays.push_back(ray);
    }
    const MarchResult result = march(make_field(scene), rays);
    CHECK(result.counters.hits == 0);
    CHECK(result.counters.invalid == 0);
  }
}

TEST_CASE("march: an empty scene is missed, and a wide floor hides nothing that stands on it", "[march]") {
  const auto nothing = scene_of(R"("objects": [{"type": "intersection", "of": [{"type": "sphere", "radius": 1},
      {"type": "sphere", "radius": 1, "translate": [5, 0, 0]}]}])");
  const auto wide = scene_of(R"("objects": [{"type": "box", "half_size": [1000, 1, 1000], "translate": [0, -1, 0]},
                                            {"type": "sphere", "radius": 0.05, "translate": [0, 0.05, 0]}])");
  std::vector<Ray> rays;
  for (int i = 0; i < 2000; ++i) {
    const double slope = std::pow(10.0, -1 - 3 * i / 2000.0);  // rise over run, towards the ball's middle
    rays.push_back({to_float({0, 0.05 + 3 * slope, 3}), to_float(glm::normalize(glm::dvec3(0, -slope, -1)))});
  }
  CHECK(march(make_field(nothing), rays).counters.hits == 0);
  const MarchResult result = march(make_field(wide), rays);
  for (const Arrival& arrival : result.arrivals) {
    if (!(arrival.t < 3)) FAIL_CHECK("the ray of slope number " << arrival.id << " went through the ball");
  }
}

TEST_CASE("march: what straddles the end of the ray", "[march]") {
  const auto scene = scene_of(kSphere);
  std::vector<Ray> rays;
  for (const double t_max : {3.9, 3.999, 4.001, 4.5, 6.5}) rays.push_back({{0, 0, 5}, {0, 0, -1}, t_max});
  const MarchResult result = march(make_field(scene), rays);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    INFO(rays[i].t_max);
    CHECK((result.arrivals[i].status == Arrival::Status::Hit) == (rays[i].t_max > 4));
  }
}

TEST_CASE("march: rays without a direction or a place are invalid, and harm no neighbour", "[march]") {
  const auto scene = scene_of(kSphere);
  const double nan = std::nan(""), inf = INFINITY;
  std::vector<Ray> rays(10, Ray{{0, 0, 5}, {0, 0, -1}});
  rays[1].direction = {0, 0, 0};
  rays[2].direction = {nan, 0, -1};
  rays[3].direction = {0, 0, -inf};
  rays[4].direction = {0, 0, -1e-320};
  rays[5].origin = {nan, 0, 5};
  rays[6].origin = {0, 0, inf};
  rays[7].t_max = nan;
  rays[8].direction = {0, 0, -7};
  const MarchResult result = march(make_field(scene), rays);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    INFO(i);
    if (i >= 1 && i <= 7) {
      CHECK(result.arrivals[i].status == Arrival::Status::Invalid);
    } else {
      REQUIRE(result.arrivals[i].status == Arrival::Status::Hit);
      CHECK(result.arrivals[i].t == Approx(4));
    }
  }
  CHECK(result.counters.invalid == 7);
}

// The ground, a torus, a box, two balls (one small) and a thin plate: accuracy's usual mixture.
const char* const kComposite = R"("objects": [{"type": "plane", "normal": [0, 1, 0], "offset": -1},
    {"type": "torus", "major_radius": 0.8, "minor_radius": 0.25, "translate": [-1.6, -0.2, 0]},
    {"type": "box", "half_size": [0.6, 0.6, 0.6], "translate": [1.3, -0.4, 0.2]},
    {"type": "sphere", "radius": 0.6, "translate": [0, 0.3, -1.2]},
    {"type": "sphere", "radius": 0.07, "translate": [0.2, -0.93, 1.4]},
    {"type": "box", "half_size": [0.5, 0.7, 0.002], "translate": [0.2, 0, 0.6]}])";

TEST_CASE("march: a composite scene agrees with certified bisection", "[march]") {
  const auto scene = scene_of(kComposite);
  const Field field = make_field(scene);
  Random random(8);
  std::vector<Ray> rays;
  for (int i = 0; i < 20000; ++i) {
    const glm::dvec3 d = glm::normalize(glm::dvec3(random.uniform(-0.6, 0.6), random.uniform(-0.45, 0.25), 1));
    rays.push_back({to_float({0, 0.6, -5}), to_float(d), 30});
  }
  // As many that start 2e-3 above the surfaces those have met.
  vm::Workspace workspace;
  const MarchResult camera = march(field, rays);
  for (std::size_t i = 0; i < 20000; ++i) {
    if (camera.arrivals[i].status != Arrival::Status::Hit) continue;
    const glm::dvec3 at = rays[i].origin + camera.arrivals[i].t * rays[i].direction;
    const glm::dvec3 normal = glm::normalize(vm::evaluate_surface(scene.surface, at, workspace).gradient);
    glm::dvec3 d = random.direction();
    if (glm::dot(d, normal) < 0) d = -d;
    rays.push_back({to_float(at + 2e-3 * normal), to_float(d), 30, 1, static_cast<float>(glm::dot(d, normal))});
  }
  const MarchResult result = march(field, rays);
  int wrong = 0, gross = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Certified truth = certify(field, rays[i].origin, rays[i].direction, 1, {0, 30, 0}, workspace);
    const bool expected = truth.status == Arrival::Status::Hit;
    wrong += expected != (result.arrivals[i].status == Arrival::Status::Hit);
    gross += expected && std::abs(truth.t - result.arrivals[i].t) > 0.02;
  }
  INFO(wrong << " wrong and " << gross << " far off of " << rays.size());
  CHECK((wrong + gross) * 1e6 <= 50.0 * static_cast<double>(rays.size()));
  CHECK(result.counters.certified * 500 <= rays.size());  // 0.2 %
  CHECK(result.counters.invalid + result.counters.exhausted == 0);
}

TEST_CASE("march: an arrival depends on its ray alone", "[march]") {
  const auto scene = scene_of(R"("objects": [{"type": "torus", "major_radius": 1, "minor_radius": 0.25},
      {"type": "box", "half_size": [0.2, 0.4, 0.3], "translate": [0.4, 0.1, 0]},
      {"type": "sphere", "radius": 0.3}])");
  const Field field = make_field(scene);
  const std::vector<Ray> rays = rays_at_sphere(2000, 4);
  const MarchResult together = march(field, rays);
  for (std::size_t i = 0; i < rays.size(); i += 7) {
    const Arrival alone = march(field, std::span(rays).subspan(i, 1)).arrivals[0];
    CHECK(alone.status == together.arrivals[i].status);
    CHECK(alone.t == together.arrivals[i].t);
  }
}

}  // namespace
}  // namespace fathom::runtime
