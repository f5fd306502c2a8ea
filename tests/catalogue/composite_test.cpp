// The adversarial catalogue, row I16: a scene of many different parts, compared with closed forms.
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "tests/catalogue/closed_forms.h"
#include "tests/catalogue/departures.h"
#include "tests/catalogue/naive.h"
#include "tests/support/catch.h"

namespace fathom::catalogue::composite_test {
namespace {

// The ground, a torus, a box, two balls (one small) and a thin plate: the usual mixture of the accuracy tests.
const char* const kComposite = R"("objects": [{"type": "plane", "normal": [0, 1, 0], "offset": -1},
    {"type": "torus", "major_radius": 0.8, "minor_radius": 0.25, "translate": [-1.6, -0.2, 0]},
    {"type": "box", "half_size": [0.6, 0.6, 0.6], "translate": [1.3, -0.4, 0.2]},
    {"type": "sphere", "radius": 0.6, "translate": [0, 0.3, -1.2]},
    {"type": "sphere", "radius": 0.07, "translate": [0.2, -0.93, 1.4]},
    {"type": "box", "half_size": [0.5, 0.7, 0.002], "translate": [0.2, 0, 0.6]}])";

constexpr double kEnd = 30;  // length of the rays, scene units

// Moves a ray into the ring's coordinates. The rounding adds an error of 1e-16.
Ray to_ring(Ray ray) {
  ray.origin -= glm::dvec3(-1.6, -0.2, 0);
  return ray;
}

Real ring_of_the_scene(const Ray& ray) {
  const Ray moved = to_ring(ray);
  if (sphere_span(moved, {0, 0, 0}, 1.06L).end < 0) return -1;  // the ray misses the ring, or starts beyond it
  return ring_distance(moved, 0.8, 0.25, kEnd);
}

// Spans of all parts except the ring and the ground.
std::array<Span, 4> spans(const Ray& ray) {
  return {box_span(ray, {1.3, -0.4, 0.2}, glm::dvec3(0.6)), sphere_span(ray, {0, 0.3, -1.2}, 0.6),
          sphere_span(ray, {0.2, -0.93, 1.4}, 0.07), box_span(ray, {0.2, 0, 0.6}, {0.5, 0.7, 0.002})};
}

bool starts_inside(const Ray& ray) {
  bool inside = ray.origin.y <= -1 || torus_field(to_ring(ray), 0, 0.8, 0.25) <= 0;
  for (const Span& span : spans(ray)) inside |= !span.empty() && span.begin <= 0 && span.end >= 0;
  return inside;
}

Real composite_distance(const Ray& ray) {
  const Real ground = (-1 - static_cast<Real>(ray.origin.y)) / ray.direction.y;
  Real first = nearer(ring_of_the_scene(ray), ground);
  for (const Span& span : spans(ray)) first = nearer(first, entry(span));
  return first <= kEnd ? first : -1;
}

std::vector<Ray> camera_rays(Random& random, int count) {
  std::vector<Ray> rays;
  for (int i = 0; i < count; ++i) {
    const glm::dvec3 d = glm::normalize(glm::dvec3(random.uniform(-0.6, 0.6), random.uniform(-0.45, 0.25), 1));
    rays.push_back({to_float({0, 0.6, -5}), to_float(d), kEnd});
  }
  return rays;
}

// Rays that start 2e-3 above the hits in `met`. Rays that would start inside another part are left out.
std::vector<Ray> bounce_rays(Random& random, const Places& met) {
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < met.hits.size(); ++i) {
    const glm::dvec3 normal(met.points[i].normal);
    glm::dvec3 d = random.direction();
    if (glm::dot(d, normal) < 0) d = -d;
    const Ray ray{to_float(met.hits[i].position + 2e-3 * normal), to_float(d), kEnd, 1,
                  static_cast<float>(glm::dot(d, normal))};
    if (!starts_inside(ray)) rays.push_back(ray);
  }
  return rays;
}

struct Tally {
  Judgement judgement;
  int gross = 0;  // hits that are off by more than 0.02: on another surface, or on none
  MarchCounters counters;
  double wrong_ppm() const { return 1e6 * (judgement.wrong() + gross) / judgement.rays; }
};

void add(Tally& tally, const Judgement& part, const MarchCounters& counters) {
  for (const double error : part.errors) tally.gross += error > 0.02;
  tally.judgement.rays += part.rays;
  tally.judgement.false_hits += part.false_hits;
  tally.judgement.false_misses += part.false_misses;
  tally.judgement.invalid += part.invalid;
  tally.counters.merge(counters);
}

// Traces `count` rays or slightly fewer: half from the camera, half from the hits of those.
Tally tally(int count, bool certified) {
  const auto scene = scene_of(kComposite);
  const Field field = make_field(scene);
  Random random(8);
  Tally all;
  constexpr int kBatch = 10000;
  for (int begin = 0; begin < count; begin += 2 * kBatch) {
    const std::vector<Ray> camera = camera_rays(random, kBatch);
    const std::vector<Ray> bounce = bounce_rays(random, places(scene, camera));
    for (const std::vector<Ray>* rays : {&camera, &bounce}) {
      const MarchResult result = march(field, *rays, {.method = certified ? Method::Certified : Method::Tiered});
      add(all, judge(result, *rays, composite_distance), result.counters);
    }
  }
  INFO(all.judgement.rays << " rays: " << all.judgement.false_hits << " false hits, " << all.judgement.false_misses
                          << " false misses, " << all.gross << " far off, " << all.counters.certified
                          << " decided in double");
  CHECK(all.judgement.rays > count / 2);
  CHECK(all.counters.invalid + all.counters.exhausted == 0);
  if (certified) {
    CHECK(all.wrong_ppm() == 0);
  } else {
    CHECK(all.wrong_ppm() <= 50);
    CHECK(all.counters.certified * 500 <= static_cast<std::uint64_t>(all.judgement.rays));  // 0.2 %
  }
  return all;
}

}  // namespace

TEST_CASE("I16: a composite scene, by float steps", "[catalogue]") { tally(40000, false); }

TEST_CASE("I16: a composite scene, by certified bisection", "[catalogue]") { tally(20000, true); }

TEST_CASE("I16: naive steps at the composite scene", "[catalogue]") {
  const auto scene = scene_of(kComposite);
  Random random(8);
  const std::vector<Ray> camera = camera_rays(random, 20000);
  const std::vector<Ray> bounce = bounce_rays(random, places(scene, camera));
  for (const std::vector<Ray>* rays : {&camera, &bounce}) {
    const Judgement naive = judge_naive(scene, *rays, composite_distance, {.eps = 1e-3, .t_max = kEnd});
    const auto gross = std::count_if(naive.errors.begin(), naive.errors.end(), [](double e) { return e > 0.02; });
    CHECK(naive.false_hits + gross + naive.exhausted > naive.rays / 2000);  // ten times the allowed rate
    CHECK(naive.p99() > 5e-3);
  }
}

TEST_CASE("I16: a million rays at a composite scene, by float steps", "[nightly][.]") {
  CHECK(tally(1300000, false).judgement.rays >= 1000000);
}

TEST_CASE("I16: a million rays at a composite scene, by certified bisection", "[nightly][.]") {
  CHECK(tally(1300000, true).judgement.rays >= 1000000);
}

}  // namespace fathom::catalogue::composite_test
