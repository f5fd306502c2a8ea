// The adversarial catalogue, rows I1 to I8: rays at one surface, for which methods fail that call a small distance a
// hit or give up after a number of steps. The truth is a closed form in long double for exactly the rays that are
// marched. Naive sphere tracing runs in addition if its result shows why the row exists. docs/explanation/accuracy.md
// lists all rows.
#include <cmath>
#include <glm/geometric.hpp>

#include "runtime/march/certify.h"
#include "tests/catalogue/naive.h"
#include "tests/support/catch.h"
#include "tests/support/scaled_cases.h"

namespace fathom::catalogue::intersection_test {
namespace {

const Naive kThousandth{.eps = 1e-3}, kTenThousandth{.eps = 1e-4}, kMillionth{.eps = 1e-6};

// Rays that pass the unit sphere's edge at distances of 1e-6 to 1e-2, log-uniform, inside the edge (-1) or outside
// (+1).
std::vector<Ray> rays_past_the_edge(int count, double side) {
  Random random(4);
  std::vector<Ray> rays;
  for (int i = 0; i < count; ++i) rays.push_back(aimed(random, 1 + side * std::pow(10.0, random.uniform(-6, -2)), 5));
  return rays;
}

// Distance by which a ray passes the unit sphere.
Real gap_of(const Ray& ray) {
  Real a = 0, b = 0, c = 0;
  for (int i = 0; i < 3; ++i) {
    const Real o = ray.origin[i], d = ray.direction[i];
    a += d * d;
    b += o * d;
    c += o * o;
  }
  return std::sqrt(c - b * b / a) - 1;
}

}  // namespace

TEST_CASE("I1: distances to a sphere, by area", "[catalogue]") {
  const auto scene = scene_of(kSphere);
  const std::vector<Ray> rays = rays_at_sphere(40000, 5);
  const Judgement found = judge(march(make_field(scene), rays), rays, sphere_distance);
  CHECK(found.wrong() == 0);
  CHECK(found.exhausted == 0);
  CHECK(found.p50() <= 1e-6);
  CHECK(found.p99() <= 5e-6);
  CHECK(found.worst() <= 1e-4);
  CHECK(judge_naive(scene, rays, sphere_distance, kThousandth).p99() > 5e-3);
}

TEST_CASE("I2: rays that graze a sphere hit it", "[catalogue]") {
  const auto scene = scene_of(kSphere);
  const std::vector<Ray> rays = rays_past_the_edge(4000, -1);
  const MarchResult result = march(make_field(scene), rays);
  const Judgement found = judge(result, rays, sphere_distance);
  CHECK(found.wrong() == 0);
  CHECK(found.exhausted == 0);
  CHECK(found.p99() <= 2e-4);
  CHECK(judge_naive(scene, rays, sphere_distance, kTenThousandth).p50() > 1e-3);
  const Judgement patient = judge_naive(scene, rays, sphere_distance, kMillionth);
  CHECK(share(patient.exhausted, patient) > 0.1);
}

TEST_CASE("I2: rays that graze a sphere take a hundred evaluations at most, on average", "[catalogue]") {
  const std::vector<Ray> rays = rays_past_the_edge(4000, -1);
  const auto scene = scene_of(kSphere);
  CHECK(march(make_field(scene), rays).counters.evaluations <= 100 * rays.size());
}

TEST_CASE("I3: near misses of a sphere miss it", "[catalogue]") {
  const auto scene = scene_of(kSphere);
  const Field field = make_field(scene);
  const std::vector<Ray> rays = rays_past_the_edge(4000, 1);
  const MarchResult result = march(field, rays);
  RealScratch scratch;
  int false_hits = 0, false_certified = 0;
  for (const RayHit& ray_hit : result.ray_hits) {
    const Ray& ray = rays[ray_hit.id];
    false_hits += ray_hit.status == RayHit::Status::Hit && gap_of(ray) > 4e-7L;
    const CertifiedResult certified = certify(field, ray.origin, ray.direction, 1, {0, 10, 0}, scratch);
    false_certified += certified.status == RayHit::Status::Hit;
  }
  CHECK(false_hits == 0);
  CHECK(false_certified == 0);
  CHECK(result.counters.exhausted == 0);
  const Judgement coarse = judge_naive(scene, rays, sphere_distance, kThousandth);
  const Judgement fine = judge_naive(scene, rays, sphere_distance, kTenThousandth);
  CHECK(share(coarse.false_hits, coarse) > 0.65);
  CHECK(share(fine.false_hits, fine) > 0.4);
}

TEST_CASE("I4: planes at grazing angles", "[catalogue]") {
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
      REQUIRE(result.ray_hits[i].status == RayHit::Status::Hit);
      worst = std::max(worst, static_cast<double>(std::abs(result.ray_hits[i].t / plane_distance(rays[i]) - 1)));
    }
    INFO(degrees << " degrees");
    CHECK(worst <= 1e-5);
    CHECK(result.counters.exhausted == 0);
    const Judgement naive = judge_naive(scene, rays, plane_distance, {.eps = 1e-4, .t_max = 1e5});
    CHECK(naive.exhausted == (degrees < 0.5 ? naive.rays : 0));
  }
}

// Heights above the floor, and half widths of a slit, from 1e-3 to 1e-2. The rays are 30 units long.
TEST_CASE("I5: a ray parallel to a plane or through a slit goes on to its end", "[catalogue]") {
  const auto floor = scene_of(kPlane);
  const auto slit = scene_of(R"("objects": [{"type": "box", "half_size": [40, 1, 40], "translate": [0, -1.005, 0]},
                                            {"type": "box", "half_size": [40, 1, 40], "translate": [0, 1.005, 0]}])");
  Random random(6);
  std::vector<Ray> above, within;
  for (int i = 0; i < 500; ++i) {
    const double turn = random.uniform(0, 2 * M_PI);
    const glm::dvec3 direction = to_float({std::cos(turn), 0, std::sin(turn)});
    above.push_back({to_float({0, i == 0 ? 2e-3 : random.uniform(1e-3, 1e-2), 0}), direction, 30});
    within.push_back({to_float({0, random.uniform(-4e-3, 4e-3), 0}), direction, 30});
  }
  const Truth miss = [](const Ray&) { return Real(-1); };
  for (const auto& [scene, rays] : {std::pair{&floor, &above}, std::pair{&slit, &within}}) {
    const MarchResult result = march(make_field(*scene), *rays);
    CHECK(judge(result, *rays, miss).wrong() == 0);
    CHECK(result.counters.exhausted == 0);
    const Judgement naive = judge_naive(*scene, *rays, miss, {.eps = 1e-4, .t_max = 30});
    CHECK(naive.exhausted == naive.rays);
  }
}

// Not met: bisection needs about ln(1 + s t / h) / 2s evaluations, where h is the height and s the slope, and gives
// up after a million. For a plane perpendicular to an axis intervals are exact.
TEST_CASE("I5: a ray all but parallel to a plane that is not across an axis is decided", "[catalogue]") {
  const auto scene = scene_of(R"("objects": [{"type": "plane", "normal": [0.6, 0.8, 0]}])");
  const glm::dvec3 normal(0.6, 0.8, 0), along = glm::normalize(glm::dvec3(0.8, -0.6, 1));
  for (const double slope : {1e-4, 1e-5, 1e-6, 0.0}) {
    const Ray ray{1e-5 * normal, glm::normalize(along + slope * normal), INFINITY, 1, static_cast<float>(slope)};
    const MarchResult result = march(make_field(scene), std::span(&ray, 1));
    INFO("slope " << slope);
    CHECK(result.ray_hits[0].status != RayHit::Status::Hit);
    CHECK(result.counters.exhausted == 0);
    CHECK(result.counters.evaluations <= 1000);
  }
}

// The ball and its rays move away together: in exact arithmetic nothing changes. I2 tests rays at the ball's edge,
// where the distance's error is many times the error of the position.
TEST_CASE("I6: a world offset of up to a million units", "[catalogue]") {
  for (const double offset : {0.0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6}) {
    const auto scene = scene_of(R"("objects": [{"type": "sphere", "radius": 1, "translate": [)" +
                                std::to_string(offset) + ", 0, 0]}]");
    Random random(7);
    std::vector<Ray> rays;
    for (int i = 0; i < 2000; ++i) {
      rays.push_back(aimed(random, 0.9 * std::sqrt(random.uniform(0, 1)), 5));
      rays.back().origin.x += offset;
    }
    const Truth truth = [&](const Ray& ray) {
      Ray back = ray;
      back.origin.x -= offset;  // exact, because the two numbers are neighbours
      return sphere_distance(back);
    };
    std::vector<Ray> local = rays;  // in the programs' coordinates
    for (Ray& ray : local) ray.origin -= scene.origin;
    Judgement found;
    const MarchResult result = march(make_field(scene), local);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      found.invalid += result.ray_hits[i].status == RayHit::Status::Invalid;
      found.note(result.ray_hits[i].status == RayHit::Status::Hit, result.ray_hits[i].t, truth(rays[i]));
    }
    std::sort(found.errors.begin(), found.errors.end());
    // Spacing of floats at the coordinates that remain after the compiler moved the solid: the compiler's origin
    // leaves none of these offsets more than 8 from zero.
    const float farthest = static_cast<float>(std::min(offset, 10.0) + 6);
    const double unit = static_cast<double>(std::nextafter(farthest, INFINITY) - farthest);
    INFO("offset " << offset << ", float's unit there " << unit);
    CHECK(found.wrong() == 0);
    CHECK(found.exhausted == 0);
    CHECK(found.worst() <= 4 * unit);
    if (offset < 1e6) continue;
    // With an equal ball on the other side of zero the compiler has no better origin, so float coordinates stay
    // coarse.
    const auto unmoved = scene_of(R"("objects": [{"type": "sphere", "radius": 1, "translate": [1e6, 0, 0]},
                                                 {"type": "sphere", "radius": 1, "translate": [-1e6, 0, 0]}])");
    CHECK(judge_naive(unmoved, rays, truth, kTenThousandth).p50() > 5e-3);
  }
}

TEST_CASE("I7: thin plates are hit on the near side", "[catalogue]") {
  for (const double half : {1e-2, 1e-3, 1e-4, 1e-5, 4e-6, 1e-6}) {
    const std::string plate = R"({"type": "box", "half_size": [1, )" + std::to_string(half * 1e6) + R"(e-6, 1]})";
    const auto scene = scene_of("\"objects\": [" + plate + "]");
    Random random(6);
    std::vector<Ray> rays;
    while (static_cast<int>(rays.size()) < test::scaled_cases(2400)) {
      const glm::dvec3 d = random.direction(), through(random.uniform(-0.7, 0.7), 0, random.uniform(-0.7, 0.7));
      if (std::abs(d.y) > 0.1) rays.push_back({to_float(through - 5.0 * d), to_float(d)});
    }
    const Truth truth = [&](const Ray& ray) {
      const Real side = ray.origin.y > 0 ? 1 : -1;
      return (side * static_cast<Real>(static_cast<float>(half)) - ray.origin.y) / ray.direction.y;
    };
    const Field field = make_field(scene);
    const Judgement found = judge(march(field, rays), rays, truth);
    const bool resolved = 2 * half >= 4 * static_cast<double>(distance_error(field, 1, 0, 1, 0));
    INFO(half);
    CHECK(resolved == (half > 2e-6));
    CHECK(found.wrong() == 0);
    CHECK(found.exhausted == 0);
    if (resolved) CHECK(found.p99() <= 5e-6);
    CHECK(found.worst() <= 2e-4);  // the far side is 2 half / |d.y| away
    const Judgement naive = judge_naive(scene, rays, truth, {.eps = 0});
    CHECK(share(naive.exhausted, naive) > 0.1);
    CHECK(codes_of(plate, true) == (half < 1.5e-5 ? "W0506" : ""));
  }
  CHECK(codes_of(R"({"type": "box", "half_size": [1, 0, 1]})") == "E0301");
  CHECK(codes_of(R"({"type": "onion", "thickness": 0, "of": {"type": "sphere", "radius": 1}})") == "E0301");
}

TEST_CASE("I8: a sphere from a hundred thousand units away", "[catalogue]") {
  const auto scene = scene_of(kSphere);
  const Field field = make_field(scene);
  const std::vector<Ray> near = rays_at_sphere(test::scaled_cases(20000), 5),
                         far = rays_at_sphere(test::scaled_cases(20000), 1e5);
  const Judgement here = judge(march(field, near), near, sphere_distance);
  const Judgement there = judge(march(field, far), far, sphere_distance);
  CHECK(there.wrong() == 0);
  CHECK(there.exhausted == 0);
  CHECK(there.p50() <= 2 * here.p50());
  CHECK(there.p99() <= 2 * here.p99());
  CHECK(there.worst() <= 1e-4);
  CHECK(judge_naive(scene, far, sphere_distance, {.eps = 1e-4, .t_max = 1e6}).p50() > 1e-3);
}

}  // namespace fathom::catalogue::intersection_test
