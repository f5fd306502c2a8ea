// Formulas that jump, turned: rays against the formula itself, sampled finely along each ray in double. No bound on
// the slope of such a formula holds all over its box (compiler/analysis/formula_cells.h), unless what is made of the
// jump is equal on both sides (vm/number/discontinuity-inl.h).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/trigonometric.hpp>
#include <string>
#include <vector>

#include "runtime/march/march.h"
#include "tests/runtime/rays.h"
#include "tests/runtime/scenes.h"
#include "tests/support/catch.h"
#include "tests/support/scaled_cases.h"

namespace fathom::runtime::jumps_test {
namespace {

double mod(double a, double b) { return a - b * std::floor(a / b); }
double compare(double a, double b) { return a < b ? -1 : a > b ? 1 : 0; }
double hypot(double a, double b) { return std::sqrt(a * a + b * b); }

struct Formula {
  const char* name;
  bool jumps;  // false: it is continuous, and proved as a whole
  std::string text;
  double (*value)(double x, double y, double z);
};
// Columns, wheels and arcades of the kind that programs export as expression lists, then single operations.
const Formula kFormulas[] = {
    {"colonnade", false, "max(min(hypot(mod(x, 1) - 0.5, mod(z, 1) - 0.5) - 0.22, 0.4 - abs(y)), abs(y) - 1.5)",
     [](double x, double y, double z) {
       return std::max(std::min(hypot(mod(x, 1) - 0.5, mod(z, 1) - 0.5) - 0.22, 0.4 - std::abs(y)),
                       std::abs(y) - 1.5);
     }},
    {"fluted column", true,
     "max(hypot(x, z) - 0.9 + 0.1 * abs(mod(atan2(z, x), 0.6283185307179586) - 0.3141592653589793), abs(y) - 1.4)",
     [](double x, double y, double z) {
       const double flute = std::abs(mod(std::atan2(z, x), 0.6283185307179586) - 0.3141592653589793);
       return std::max(hypot(x, z) - 0.9 + 0.1 * flute, std::abs(y) - 1.4);
     }},
    {"toothed wheel", true, "max(hypot(x, z) - 1.2 - 0.1 * compare(mod(atan2(z, x), 0.5236), 0.26), abs(y) - 0.5)",
     [](double x, double y, double z) {
       return std::max(hypot(x, z) - 1.2 - 0.1 * compare(mod(std::atan2(z, x), 0.5236), 0.26), std::abs(y) - 0.5);
     }},
    {"compare across a slope", true, "compare(x, 0.3 * y) * 0.4 + y - 0.5 * x + 0.2",
     [](double x, double y, double) { return compare(x, 0.3 * y) * 0.4 + y - 0.5 * x + 0.2; }},
    {"off-centre cells", true, "sqrt((mod(x + 0.3, 1.1) - 0.5)^2 + (mod(z - 0.2, 0.9) - 0.4)^2 + y^2) - 0.35",
     [](double x, double y, double z) {
       const double u = mod(x + 0.3, 1.1) - 0.5, w = mod(z - 0.2, 0.9) - 0.4;
       return std::sqrt(u * u + w * w + y * y) - 0.35;
     }},
    {"tangent", true, "y - 0.3 * tan(x + 0.4 * z)",
     [](double x, double y, double z) { return y - 0.3 * std::tan(x + 0.4 * z); }},
    {"stairs", true, "y - 0.25 * floor(2 * x + 0.7 * z)",
     [](double x, double y, double z) { return y - 0.25 * std::floor(2 * x + 0.7 * z); }},
};

constexpr glm::dvec3 kTurns[] = {{0, 0, 0}, {20, 30, 10}, {-50, 75, 140}};
constexpr double kHalf = 2;  // of the formula's box

glm::dmat3 rotation(glm::dvec3 degrees) {
  const glm::dvec3 a = degrees * (M_PI / 180), c = glm::cos(a), s = glm::sin(a);
  const glm::dmat3 x(1, 0, 0, 0, c.x, s.x, 0, -s.x, c.x), y(c.y, 0, -s.y, 0, 1, 0, s.y, 0, c.y),
      z(c.z, s.z, 0, -s.z, c.z, 0, 0, 0, 1);
  return z * y * x;
}

// A solid along a ray: below 0 within the formula's solid and its box.
struct Truth {
  const Formula& formula;
  glm::dmat3 to_local;
  const Ray& ray;

  double operator()(double t) const {
    const glm::dvec3 p = to_local * (ray.origin + t * ray.direction), out = glm::abs(p) - kHalf;
    const double value = formula.value(p.x, p.y, p.z);
    return std::max({value, out.x, out.y, out.z});
  }
};

struct Counts {
  int hits = 0, wrong = 0, slivers = 0;
};

// Solids that a ray passes through in a shorter way may be passed over: 16 bands (runtime/march/tiered-inl.h).
constexpr double kSliver = 16 * 1e-4 * 5;
constexpr double kStep = 1.0 / 1024, kReach = 8;

// Compares a result with the first sample in the solid.
void judge(const RayHit& ray_hit, const Truth& truth, Counts& counts) {
  const double near = 1e-4;
  const bool hit = ray_hit.status == RayHit::Status::Hit;
  counts.hits += hit;
  // A hit is at a change of sign, even if the ray leaves the solid again after some millionths.
  if (hit && !(truth(ray_hit.t - near) > 0 && truth(ray_hit.t + near) < 0)) {
    constexpr int kFine = 1000;
    double least = INFINITY;
    for (int i = -kFine; i <= kFine; ++i) least = std::min(least, truth(ray_hit.t + near * i / kFine));
    if (!(least < 0)) return void(++counts.wrong);
  }
  const double end = hit ? ray_hit.t - near : kReach;
  for (double t = kStep; t < end; t += kStep) {
    if (!(truth(t) < 0)) continue;
    double out = t;
    while (out < end && truth(out) < 0) out += kStep / 16;
    double in = t;
    while (in > t - kStep && truth(in) < 0) in -= kStep / 16;
    if (out - in > kSliver) return void(++counts.wrong);
    ++counts.slivers;
    t = out;
  }
}

Counts count(const Formula& formula, glm::dvec3 turn, int rays_wanted) {
  const auto scene = scene_of(fmt::format(
      R"("objects": [{{"type": "expression", "formula": "{}", "half_size": [{}, {}, {}], "rotate": [{}, {}, {}]}}])",
      formula.text, kHalf, kHalf, kHalf, turn.x, turn.y, turn.z));
  const Field field = make_field(scene);
  REQUIRE((field.cells != nullptr) == formula.jumps);
  Random random(7);
  std::vector<Ray> rays;
  const glm::dmat3 to_local = glm::transpose(rotation(turn));
  while (static_cast<int>(rays.size()) < rays_wanted) {
    const glm::dvec3 target(random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-2, 2));
    const glm::dvec3 origin = 4.0 * random.direction();
    const Ray ray{origin, glm::normalize(target - origin)};
    if (Truth{formula, to_local, ray}(0) > 0) rays.push_back(ray);
  }
  const MarchResult result = march(field, rays);
  std::uint64_t instructions = 0;
  for (const RayHit& ray_hit : result.ray_hits) instructions += ray_hit.instructions;
  CHECK(instructions == result.counters.instructions);
  CHECK(result.counters.certified <= rays.size());
  Counts counts;
  for (std::size_t i = 0; i < rays.size(); ++i) judge(result.ray_hits[i], {formula, to_local, rays[i]}, counts);
  return counts;
}

void check(int rays) {
  for (const Formula& formula : kFormulas) {
    for (const glm::dvec3 turn : kTurns) {
      const Counts counts = count(formula, turn, rays);
      CAPTURE(formula.name, turn.x, turn.y, turn.z, counts.hits, counts.slivers);
      CHECK(counts.wrong == 0);
      CHECK(counts.hits > rays / 20);
    }
  }
}

// Regression: a ray that goes on in float after a search started outside, although it was within the solid, and hit
// at once.
TEST_CASE("jumps: a ray within a solid leaves it where the solid ends", "[march]") {
  const auto scene = scene_of(R"_("objects": [{"type": "expression", "half_size": [2, 2, 2],
      "formula": "y - 0.25 * floor(2 * x + 0.7 * z)"}])_");
  const Field field = make_field(scene);
  REQUIRE(field.cells);
  // Along a step, less than the error of float below its top.
  const std::vector<Ray> rays = {{{0.1, -1e-6, -0.1}, {0.33035, 0, -0.94386}}, {{-1, -1.9, 0}, {1, 0, 0.01}}};
  for (const Ray& ray : rays) {
    const RayHit found = march(field, std::span(&ray, 1)).ray_hits[0];
    const RayHit exact = march(field, std::span(&ray, 1), {.method = Method::Certified}).ray_hits[0];
    CHECK(exact.side == -1);
    CHECK(found.side == exact.side);
    CHECK(found.t == Approx(exact.t).epsilon(1e-5));
  }
}

TEST_CASE("jumps: rays hit formulas that jump where these change their sign", "[march]") {
  check(test::scaled_cases(120));
}

TEST_CASE("jumps: a hundred thousand rays of every formula", "[march][heavy]") { check(test::scaled_cases(33334)); }

}  // namespace
}  // namespace fathom::runtime::jumps_test
