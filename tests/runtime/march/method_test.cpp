// The guarantees of each method of runtime/march/method.h, in both precisions, and regressions of the default method.
#include "runtime/march/method.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <string>
#include <tuple>

#include "runtime/march/march.h"
#include "runtime/sampling/camera.h"
#include "tests/runtime/rays.h"
#include "tests/runtime/scenes.h"
#include "tests/support/catch.h"
#include "tests/vm/number/float_bits.h"

namespace fathom::runtime::method_test {
namespace {

using Status = RayHit::Status;

const char* const kMixed = R"("camera": {"position": [0, 1, -5], "target": [0, 0, 0]},
    "objects": [{"type": "plane", "normal": [0, 1, 0], "offset": -1},
      {"type": "torus", "major_radius": 0.8, "minor_radius": 0.25, "translate": [-1.4, -0.2, 0]},
      {"type": "box", "half_size": [0.5, 0.4, 0.6], "translate": [1.3, -0.2, 0.2]},
      {"type": "sphere", "radius": 0.6, "translate": [0, 0.3, -0.5]}])";

// The camera rays of an image of this height, twice as wide.
std::vector<Ray> camera_rays(const compiler::CompiledScene& scene, int height) {
  const Camera camera(scene.camera, 2 * height, height);
  std::vector<Ray> rays;
  for (int i = 0; i < 2 * height * height; ++i) {
    const CameraRay ray = camera.ray(i % (2 * height) + 0.5, i / (2 * height) + 0.5);
    rays.push_back({to_float(ray.origin), to_float(ray.direction)});
  }
  return rays;
}

std::vector<Marching> all_methods(double epsilon) {
  std::vector<Marching> all;
  for (const MethodInfo& method : kMethods) {
    for (const Precision precision : {Precision::Single, Precision::Double}) {
      if (method.method == Method::Certified && precision == Precision::Single) continue;
      all.push_back({.method = method.method, .precision = precision, .epsilon = epsilon, .steps = 2000});
    }
  }
  return all;
}

std::string name_of(const Marching& marching) {
  return std::string(info(marching.method).name) + (marching.precision == Precision::Double ? " f64" : " f32") +
         " eps " + std::to_string(marching.epsilon);
}

// Returns the error of a hit that float rounding explains, in scene units.
double noise_of(const Marching& marching) {
  if (marching.method == Method::Certified) return 1e-11;
  return marching.precision == Precision::Double ? 1e-10 : 2e-5;
}

// A ray whose first hit is known.
struct Known {
  Ray ray;
  double t, cosine;  // cosine of the angle between the ray and the normal at the hit
};

// Rays that hit the unit sphere at max 80 degrees from the normal.
std::vector<Known> known_sphere_hits() {
  std::vector<Known> known;
  Random random(21);
  for (int i = 0; i < 1500; ++i) {
    const Ray ray = aimed(random, random.uniform(0, 0.98), 4);
    const double t = static_cast<double>(sphere_distance(ray));
    const glm::dvec3 at = ray.origin + t * ray.direction;
    known.push_back({ray, t, std::abs(glm::dot(at, ray.direction))});
  }
  return known;
}

// Rays that hit a face of the box far from its edges, where the field is that of the face's plane.
std::vector<Known> known_box_hits() {
  constexpr double kHalf[] = {0.75, 0.5, 1.0}, kFromEdge = 0.1;
  std::vector<Known> known;
  Random random(22);
  while (known.size() < 1500) {
    const glm::dvec3 d = random.direction(), inner(random.uniform(-0.7, 0.7), random.uniform(-0.45, 0.45), 0.2);
    const Ray ray{to_float(inner - 4.0 * d), to_float(d)};
    const double t = static_cast<double>(box_distance(ray));
    const glm::dvec3 at = ray.origin + t * ray.direction;
    for (int axis = 0; axis < 3; ++axis) {
      bool face = std::abs(std::abs(at[axis]) - kHalf[axis]) < 1e-9 && std::abs(ray.direction[axis]) > 0.2;
      for (const int other : {(axis + 1) % 3, (axis + 2) % 3}) face &= std::abs(at[other]) < kHalf[other] - kFromEdge;
      if (face) known.push_back({ray, t, std::abs(ray.direction[axis])});
    }
  }
  return known;
}

void expect_promised(const char* scene_text, const std::vector<Known>& known) {
  const auto scene = scene_of(scene_text);
  const Field field = make_field(scene);
  std::vector<Ray> rays;
  for (const Known& each : known) rays.push_back(each.ray);
  for (const double epsilon : {1e-2, 1e-4}) {
    for (const Marching& marching : all_methods(epsilon)) {
      INFO(scene_text << ": " << name_of(marching));
      const MarchResult result = march(field, rays, marching);
      const double allowed = info(marching.method).uses_epsilon ? epsilon : 0;
      double excess = -1;  // largest excess of an error over eps / cosine
      int missed = 0;
      for (std::size_t i = 0; i < known.size(); ++i) {
        missed += result.ray_hits[i].status != Status::Hit;
        excess = std::max(excess, std::abs(result.ray_hits[i].t - known[i].t) - allowed / known[i].cosine);
      }
      CHECK(missed == 0);
      CHECK(excess <= noise_of(marching));
    }
  }
}

TEST_CASE("method: the table is in the order of the enum, and its names differ", "[march]") {
  std::map<std::string_view, int> names;
  for (std::size_t i = 0; i < std::size(kMethods); ++i) {
    CHECK(static_cast<std::size_t>(kMethods[i].method) == i);
    CHECK(&info(kMethods[i].method) == &kMethods[i]);
    CHECK(kMethods[i].summary != "");
    CHECK(++names[kMethods[i].name] == 1);
  }
  CHECK(kMethods[std::size(kMethods) - 1].method == Method::Certified);
}

TEST_CASE("method: every method finds a sphere's and a box's hits within what it promises", "[march]") {
  expect_promised(kSphere, known_sphere_hits());
  expect_promised(kBox, known_box_hits());
}

// Regression: the marcher took a relaxed step that ended behind the surface when its sphere overlapped the last one.
// The hit was reported there, up to 0.6 of the last safe radius too far.
TEST_CASE("method: a ray straight at a plane does not hit what is behind it", "[march]") {
  const auto scene = scene_of(kPlane);
  const Field field = make_field(scene);
  std::vector<Ray> rays;
  for (int i = 0; i < 300; ++i) {
    const double aside = i == 0 ? 0 : std::pow(10.0, -9 + 8.0 * i / 300);
    rays.push_back({{0, 0.5 + i / 64.0, 0}, to_float(glm::normalize(glm::dvec3(aside, -1, 0)))});
  }
  for (const double relaxation : {1.2, 1.6, 1.99}) {
    for (Marching marching : all_methods(1e-4)) {
      marching.relaxation = relaxation;
      INFO(name_of(marching) << ", relaxation " << relaxation);
      double worst = 0;
      for (const RayHit& ray_hit : march(field, rays, marching).ray_hits) {
        REQUIRE(ray_hit.status == Status::Hit);
        const Ray& ray = rays[ray_hit.id];
        worst = std::max(worst, std::abs(ray_hit.t - static_cast<double>(plane_distance(ray))));
      }
      CHECK(worst <= 1.1e-4);
    }
  }
}

TEST_CASE("method: those with a threshold give rays up after `steps`, as misses", "[march]") {
  const auto scene = scene_of(kSphere);
  const Field field = make_field(scene);
  Random random(23);
  std::vector<Ray> rays;
  for (int i = 0; i < 500; ++i) rays.push_back(aimed(random, random.uniform(0.5, 0.9), 4));
  for (Marching marching : all_methods(1e-5)) {
    marching.steps = 3;
    INFO(name_of(marching));
    const MarchResult result = march(field, rays, marching);
    if (!info(marching.method).uses_epsilon) {
      CHECK(result.counters.exhausted == 0);
      CHECK(result.counters.hits == rays.size());
      continue;
    }
    CHECK(result.counters.exhausted > rays.size() / 2);
    CHECK(result.counters.exhausted == result.counters.misses);
    for (const RayHit& ray_hit : result.ray_hits) {
      CHECK(ray_hit.evaluations <= 3);
      if (ray_hit.status != Status::Hit) CHECK(ray_hit.evaluations == 3);
    }
  }
}

TEST_CASE("method: relaxed steps take fewer evaluations than plain ones", "[march]") {
  const auto scene = scene_of(kMixed);
  const Field field = make_field(scene);
  const std::vector<Ray> rays = camera_rays(scene, 50);
  const auto evaluations = [&](Method method, double epsilon) {
    return march(field, rays, {.method = method, .epsilon = epsilon}).counters.evaluations;
  };
  for (const double epsilon : {1e-3, 1e-4}) {
    const std::uint64_t plain = evaluations(Method::Sphere, epsilon);
    INFO("eps " << epsilon << ", " << rays.size() << " rays: sphere " << plain);
    CHECK(evaluations(Method::Relaxed, epsilon) < plain);
    CHECK(evaluations(Method::Automatic, epsilon) < plain - plain / 5);
  }
}

// All members of a RayHit, as bits.
std::tuple<Status, int, std::uint32_t, std::uint32_t, std::uint32_t, std::uint64_t> bits_of(const RayHit& ray_hit) {
  return {ray_hit.status,
          ray_hit.side,
          ray_hit.evaluations,
          ray_hit.certified,
          std::bit_cast<std::uint32_t>(ray_hit.width),
          std::bit_cast<std::uint64_t>(ray_hit.t)};
}

int count_differences(const std::vector<RayHit>& a, const std::vector<RayHit>& b) {
  int differences = 0;
  for (std::size_t i = 0; i < a.size(); ++i) differences += bits_of(a[i]) != bits_of(b[i]);
  return differences;
}

TEST_CASE("method: the same bits on every instruction set", "[march]") {
  const auto scene = scene_of(kMixed);
  const Field field = make_field(scene);
  const std::vector<Ray> rays = camera_rays(scene, 24);
  const test::IsaGuard guard;
  for (const MethodInfo& method : kMethods) {
    REQUIRE(vm::force_isa("scalar"));
    const std::vector<RayHit> expected = march(field, rays, {.method = method.method}).ray_hits;
    for (const std::string_view isa : vm::available_isas()) {
      INFO(method.name << " on " << isa);
      REQUIRE(vm::force_isa(isa));
      CHECK(count_differences(expected, march(field, rays, {.method = method.method}).ray_hits) == 0);
    }
  }
}

TEST_CASE("method: the result of a ray does not depend on the other rays or their order", "[march]") {
  const auto scene = scene_of(kMixed);
  const Field field = make_field(scene);
  const std::vector<Ray> rays = camera_rays(scene, 16);
  std::vector<std::size_t> order(rays.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::shuffle(order.begin(), order.end(), std::mt19937(24));
  for (const Marching& marching : all_methods(1e-4)) {
    const std::vector<RayHit> expected = march(field, rays, marching).ray_hits;
    for (const std::size_t batch : {std::size_t{1}, std::size_t{37}, rays.size()}) {
      std::vector<RayHit> found(rays.size());
      for (std::size_t begin = 0; begin < rays.size(); begin += batch) {
        std::vector<Ray> part;
        for (std::size_t i = begin; i < std::min(begin + batch, rays.size()); ++i) part.push_back(rays[order[i]]);
        for (const RayHit& ray_hit : march(field, part, marching).ray_hits)
          found[order[begin + ray_hit.id]] = ray_hit;
      }
      INFO(name_of(marching) << ", " << batch << " rays at a time");
      CHECK(count_differences(expected, found) == 0);
    }
  }
}

TEST_CASE("method: the counters add up", "[march]") {
  const auto scene = scene_of(R"("objects": [{"type": "sphere", "radius": 1},
      {"type": "box", "half_size": [1, 0.01, 1], "translate": [0, 0, 1]}])");
  const Field field = make_field(scene);
  Random random(25);
  std::vector<Ray> rays;
  for (int i = 0; i < 1000; ++i) rays.push_back(aimed(random, random.uniform(0, 3), 4));
  rays.push_back({{0, 0, 4}, {0, 0, 0}});      // no direction
  rays.push_back({{NAN, 0, 4}, {0, 0, -1}});   // no origin
  rays.push_back({{2, 0.01, -5}, {0, 0, 1}});  // past the plate
  for (const Marching& marching : all_methods(1e-4)) {
    INFO(name_of(marching));
    const MarchResult result = march(field, rays, marching);
    const MarchCounters& counters = result.counters;
    std::map<Status, std::uint64_t> ends;
    std::uint64_t evaluations = 0, in_double = 0, decided_in_double = 0;
    for (const RayHit& ray_hit : result.ray_hits) {
      ++ends[ray_hit.status];
      evaluations += ray_hit.evaluations;
      in_double += ray_hit.certified;
      decided_in_double += ray_hit.certified > 0;
    }
    CHECK(counters.rays == rays.size());
    CHECK(counters.hits == ends[Status::Hit]);
    CHECK(counters.misses == ends[Status::Miss]);
    CHECK(counters.near_misses == ends[Status::NearMiss]);
    CHECK(counters.invalid == ends[Status::Invalid]);
    CHECK(counters.invalid == 2);
    CHECK(counters.hits + counters.misses + counters.near_misses + counters.invalid == counters.rays);
    CHECK(counters.evaluations == evaluations);
    CHECK(counters.certified_evaluations == in_double);
    CHECK(counters.certified >= decided_in_double);
    CHECK(counters.clipped > 0);
    CHECK(counters.clipped + counters.certified + counters.invalid <= counters.rays);
    CHECK(counters.exhausted <= counters.misses);
    if (marching.method == Method::Certified) CHECK(counters.certified + counters.clipped + 2 == counters.rays);
  }
}

// Returns the largest difference in t where both hit. FAILs where only one hits.
double worst_difference(const std::vector<RayHit>& found, const std::vector<RayHit>& truth) {
  double worst = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (found[i].status != truth[i].status) FAIL_CHECK("ray " << i << " ends otherwise than in double");
    worst = std::max(worst, std::abs(found[i].t - truth[i].t));
  }
  return worst;
}

// Regression: a bracket that contained both the box's face and the ground below ended at the zero inside the solid,
// where the box's bottom touches the ground. Hits were 7.7e-4 too far.
TEST_CASE("method: a box that stands on the ground is hit at its face, just above the ground", "[march]") {
  const auto scene = scene_of(R"("objects": [{"type": "plane", "normal": [0, 1, 0], "offset": -1},
      {"type": "box", "half_size": [0.6, 0.6, 0.6], "translate": [1.3, -0.4, 0.2]}])");
  const Field field = make_field(scene);
  const glm::dvec3 eye(0, 0.6, -5);
  Random random(26);
  std::vector<Ray> rays;
  for (int i = 0; i < 20000; ++i) {
    const glm::dvec3 aim(random.uniform(0.72, 1.88), -1 + std::pow(10, random.uniform(-6, -2.7)), -0.4);
    rays.push_back({to_float(eye), to_float(glm::normalize(aim - eye))});
  }
  const MarchResult truth = march(field, rays, {.method = Method::Certified});
  CHECK(truth.counters.hits == rays.size());
  CHECK(worst_difference(march(field, rays).ray_hits, truth.ray_hits) <= 2e-5);
}

// Along a ray near a ball's outline, the field is nearly level, and float resolves few digits of the root. The
// marcher decides in double where float cannot, but not for all of these rays.
TEST_CASE("method: grazing hits of a ball are not vague", "[march]") {
  const auto scene = scene_of(kSphere);
  Random random(27);
  std::vector<Ray> nearly_past, shallow;
  for (int i = 0; i < 4000; ++i) nearly_past.push_back(aimed(random, 1 - std::pow(10, random.uniform(-6, -4)), 5));
  for (int i = 0; i < 4000; ++i) shallow.push_back(aimed(random, 1 - std::pow(10, random.uniform(-4, -1)), 5));
  for (const std::vector<Ray>* rays : {&nearly_past, &shallow}) {
    const MarchResult result = march(make_field(scene), *rays);
    const Judgement judgement = judge(result, *rays, sphere_distance);
    INFO(result.counters.certified << " of " << rays->size() << " decided in double");
    CHECK(judgement.wrong() == 0);
    CHECK(judgement.errors.size() == rays->size());
    CHECK(judgement.worst() <= 1e-4);
    if (rays == &shallow) CHECK(result.counters.certified < rays->size() / 2);
  }
}

// Regression: these rays hit nothing, but the flat copies leave only tiny safe steps. The search in double took more
// than 1e5 evaluations per ray.
TEST_CASE("method: among flat copies rays end in reasonable evaluations", "[march][heavy]") {
  const auto scene = scene_of(R"("objects": [{"type": "repetition", "period": [0.5, 1, 1], "scale": [1, 0.0003, 1],
      "of": {"type": "intersection", "of": [{"type": "box", "half_size": [0.01, 1, 0.2], "translate": [-0.12, 0, 0]},
                                            {"type": "box", "half_size": [0.06, 1, 0.6]}]}}])");
  const std::vector<Ray> rays = camera_rays(scene, 3);
  for (const Method method : {Method::Tiered, Method::Certified}) {
    const MarchResult result = march(make_field(scene), rays, {.method = method});
    std::uint32_t most = 0;
    for (const RayHit& ray_hit : result.ray_hits) most = std::max(most, ray_hit.evaluations);
    INFO(info(method).name << ": " << result.counters.evaluations / rays.size() << " evaluations per ray, at most "
                           << most);
    CHECK(most <= 4 * kSearchBudget);
    CHECK(result.counters.hits + result.counters.invalid == 0);
  }
}

}  // namespace
}  // namespace fathom::runtime::method_test
