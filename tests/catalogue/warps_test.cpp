// The adversarial catalogue, row F3 and the jittered copies of F4: rays at nodes that bend, scale, repeat and
// displace space. The truth comes from an independent search: fields written here in plain doubles, their true
// Lipschitz constants, and bisection that skips an interval only if the distances at its ends cover the interval.
// Sphere tracing with the raw value as the step, as in most programs, is wrong for the fraction of rays that the
// heavy test prints. The compiled scenes must be right for every ray.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "runtime/march/march.h"
#include "tests/support/catch.h"
#include "tests/support/compiled.h"
#include "tests/support/random/random_scene.h"

namespace fathom::test::warps_test {
namespace {

using glm::dvec3;
using Field = std::function<double(dvec3)>;

double box(dvec3 p, dvec3 half) {
  const dvec3 q = glm::abs(p) - half;
  return glm::length(glm::max(q, dvec3(0))) + std::min(0.0, std::max({q.x, q.y, q.z}));
}

struct Case {
  const char* row;  // row of the catalogue
  const char* name;
  std::string node;
  Field field;       // its zeros are the solid's surface
  double lipschitz;  // of `field`, within `radius` of the origin
  double radius;     // of a ball that contains the solid
  Field naive;       // step of a naive sphere tracer
};

// Twisted blade: the point is rotated by -k y, which makes the blade straight.
double blade(dvec3 p) {
  const double angle = -5 * p.y, c = std::cos(angle), s = std::sin(angle);
  return box({p.x * c + p.z * s, p.y, p.z * c - p.x * s}, {0.5, 1, 0.05});
}

// Beam whose x axis is bent into an arc of 45 degrees per unit towards +y. The angle and the radius map a point back
// to the straight beam (Barr, "Global and Local Deformations of Solid Primitives", 1984).
constexpr double kArc = M_PI / 4;
double arched_beam(dvec3 p) {
  const double down = 1 / kArc - p.y;
  return box({std::atan2(p.x, down) / kArc, 1 / kArc - std::hypot(p.x, down), p.z}, {1, 0.1, 0.3});
}

double tapered_block(dvec3 p) {
  const double s = 1 + (0.4 - 1) * std::clamp((p.y + 1) / 2, 0.0, 1.0);
  return box({p.x / s, p.y, p.z / s}, {0.5, 1, 0.5});
}

double stretched_ring(dvec3 p) {
  const dvec3 q = p / dvec3(3, 1, 0.4);
  return std::hypot(std::hypot(q.x, q.z) - 0.5, q.y) - 0.2;
}

long permuted(long n) {
  const long m = ((n % 289) + 289) % 289;
  return m * (34 * m + 1) % 289;
}

// One of 5 x 5 x 5 balls, each moved by up to 0.15 along each axis.
double scattered_ball(dvec3 p, long i, long j, long l) {
  const long x = permuted(permuted(permuted(i) + j) + l), y = permuted(x + 1), z = permuted(y + 1);
  return glm::length(p - 0.6 * dvec3(i, j, l) - 0.15 * (dvec3(x, y, z) / 144.0 - dvec3(1))) - 0.2;
}
double scattered_balls(dvec3 p) {
  double nearest = 1e9;
  for (long i = -2; i <= 2; ++i) {
    for (long j = -2; j <= 2; ++j) {
      for (long l = -2; l <= 2; ++l) nearest = std::min(nearest, scattered_ball(p, i, j, l));
    }
  }
  return nearest;
}
double ball_of_own_cell(dvec3 p) {
  const auto cell = [](double a) { return std::clamp(std::lround(a / 0.6), -2L, 2L); };
  return scattered_ball(p, cell(p.x), cell(p.y), cell(p.z));
}

double rough_ball(dvec3 p) {
  return glm::length(p) - 1 + 0.05 * std::sin(20 * p.x) * std::sin(20 * p.y) * std::sin(20 * p.z);
}

const std::vector<Case>& cases() {
  // Largest singular value of [[1, kR], [0, 1]], where R is the radius of the ball in which rays are searched.
  const double kr = 5 * 1.13;
  static const std::vector<Case> all = {
      {"F3", "twist, k = 5",
       R"({"type": "twist", "turn": "5*180/pi", "of": {"type": "box", "half_size": [0.5, 1, 0.05]}})", blade,
       (kr + std::sqrt(kr * kr + 4)) / 2, 1.13, blade},
      {"F3", "bend, 45 degrees a unit",
       R"({"type": "bend", "turn": 45, "of": {"type": "box", "half_size": [1, 0.1, 0.3]}})", arched_beam,
       1 / (kArc * (1 / kArc - 1.1)), 1.1, arched_beam},
      {"F3", "taper, 1 to 0.4",
       R"({"type": "taper", "bottom": 1, "top": 0.4, "half_height": 1, "of": {"type": "box", "half_size": [0.5, 1, 0.5]}})",
       tapered_block, 1 / 0.4 + 0.3 * 1.3 / (0.4 * 0.4), 1.3, tapered_block},
      {"F3", "scale 3:1:0.4", R"({"type": "torus", "major_radius": 0.5, "minor_radius": 0.2, "scale": [3, 1, 0.4]})",
       stretched_ring, 1 / 0.4, 2.2, stretched_ring},
      {"F4", "jittered repetition",
       R"({"type": "repetition", "period": [0.6, 0.6, 0.6], "count": [5, 5, 5], "jitter": [0.15, 0.15, 0.15],
           "of": {"type": "sphere", "radius": 0.2}})",
       scattered_balls, 1, 2.8, ball_of_own_cell},
      {"F3", "displacement, a w = 1",
       R"J({"type": "displacement", "formula": "0.05*sin(20*x)*sin(20*y)*sin(20*z)",
           "of": {"type": "sphere", "radius": 1}})J",
       rough_ball, 2, 1.06, rough_ball},
  };
  return all;
}

struct Line {
  dvec3 origin, direction;
  dvec3 at(double t) const { return origin + t * direction; }
};

// Line from a sphere around the solid towards a random point of a disc that covers the solid.
Line random_line(const Case& c, Random& random) {
  const dvec3 from = 3 * c.radius * random.direction();
  const dvec3 side = glm::normalize(glm::cross(from, random.direction()));
  const dvec3 target = c.radius * std::sqrt(random.uniform(0, 1)) * side;
  return {dvec3(glm::vec3(from)), dvec3(glm::vec3(glm::normalize(target - from)))};
}

enum class Outcome { Miss, Hit, NearMiss };
struct Truth {
  Outcome outcome;
  double t;
};

// First zero of the field along the line inside the ball that contains the solid. The outcome is a contact if nine
// digits cannot tell a touch from a miss.
Truth search(const Case& c, const Line& line) {
  constexpr double kResolution = 1e-9;
  const double middle = -glm::dot(line.origin, line.direction) / glm::dot(line.direction, line.direction);
  const double square = c.radius * c.radius - glm::dot(line.at(middle), line.at(middle));
  if (square <= 0) return {Outcome::Miss, 0};
  struct PrunedProgram {
    double a, fa, b, fb;
  };
  const double begin = middle - std::sqrt(square), end = middle + std::sqrt(square);
  std::vector<PrunedProgram> parts = {{begin, c.field(line.at(begin)), end, c.field(line.at(end))}};
  bool near_miss = false;
  while (!parts.empty()) {
    const PrunedProgram p = parts.back();
    parts.pop_back();
    if (p.fa <= 0) return {Outcome::Hit, p.a};
    if (p.fb > 0 && p.fa + p.fb > c.lipschitz * (p.b - p.a)) continue;
    const double m = (p.a + p.b) / 2;
    if (p.b - p.a < kResolution) {
      if (p.fb <= 0) return {Outcome::Hit, m};
      near_miss = true;
      continue;
    }
    const double fm = c.field(line.at(m));
    parts.push_back({m, fm, p.b, p.fb});
    parts.push_back({p.a, p.fa, m, fm});
  }
  return {near_miss ? Outcome::NearMiss : Outcome::Miss, 0};
}

constexpr double kGross = 0.02;  // scene units: a hit that is this far off is on another surface

// Sphere tracing with the raw value as the step.
Truth naive(const Case& c, const Line& line) {
  double t = 0;
  for (int i = 0; i < 1000 && t < 10 * c.radius; ++i) {
    const double f = c.naive(line.at(t));
    if (f < 1e-5) return {Outcome::Hit, t};
    t += f;
  }
  return {Outcome::Miss, 0};
}

struct Tally {
  int rays = 0, hits = 0, near_misses = 0, wrong = 0, naive_wrong = 0;
  double worst = 0;  // max error of a hit, scene units
  double evaluations = 0;
};

Tally tally(const Case& c, int count) {
  const compiler::CompiledScene scene = test::compiled_objects(c.node);
  CHECK(scene.certified);
  Random random(11);
  std::vector<Line> lines;
  std::vector<runtime::Ray> rays;
  for (int i = 0; i < count; ++i) {
    lines.push_back(random_line(c, random));
    rays.push_back({lines.back().origin, lines.back().direction});
  }
  const runtime::MarchResult marched = runtime::march(runtime::make_field(scene), rays);
  Tally result{.rays = count};
  result.evaluations = static_cast<double>(marched.counters.evaluations) / count;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const Truth truth = search(c, lines[i]);
    result.hits += truth.outcome == Outcome::Hit;
    result.near_misses += truth.outcome == Outcome::NearMiss;
    if (truth.outcome == Outcome::NearMiss) continue;
    const auto wrong = [&](bool hit, double t) {
      return hit != (truth.outcome == Outcome::Hit) || (hit && std::abs(t - truth.t) > kGross);
    };
    const bool hit = marched.ray_hits[i].status == runtime::RayHit::Status::Hit;
    const Truth guess = naive(c, lines[i]);
    result.wrong += wrong(hit, marched.ray_hits[i].t);
    result.naive_wrong += wrong(guess.outcome == Outcome::Hit, guess.t);
    if (hit && truth.outcome == Outcome::Hit && !wrong(hit, marched.ray_hits[i].t)) {
      result.worst = std::max(result.worst, std::abs(marched.ray_hits[i].t - truth.t));
    }
  }
  return result;
}

// Traces `count` rays at each case of the row and expects all to be right.
void expect_right(const std::string& row, int count) {
  for (const Case& c : cases()) {
    if (row != c.row) continue;
    const Tally result = tally(c, count);
    INFO(c.name << ": " << result.hits << " hits, " << result.near_misses << " contacts");
    CHECK(result.wrong == 0);
    CHECK(result.hits > count / 15);
    CHECK(result.naive_wrong > count / 100);
  }
}

}  // namespace

TEST_CASE("F3: no ray is wrong at what is twisted, bent, tapered, stretched or displaced", "[catalogue]") {
  expect_right("F3", 3000);
}

TEST_CASE("F4: no ray is wrong at jittered copies", "[catalogue]") { expect_right("F4", 3000); }

TEST_CASE("F3 and F4: ten thousand rays at each", "[catalogue][heavy]") {
  for (const Case& c : cases()) {
    INFO(c.name);
    CHECK(tally(c, 10000).wrong == 0);
  }
}

TEST_CASE("F3 and F4: a hundred thousand rays at each", "[nightly][.]") {
  std::printf("%-24s %8s %8s %8s %8s %10s %10s %8s\n", "", "rays", "hits", "contacts", "wrong", "naive, %", "worst",
              "evals");
  for (const Case& c : cases()) {
    const Tally r = tally(c, 100000);
    std::printf("%-24s %8d %8d %8d %8d %10.2f %10.2g %8.1f\n", c.name, r.rays, r.hits, r.near_misses, r.wrong,
                100.0 * r.naive_wrong / r.rays, r.worst, r.evaluations);
    CHECK(r.wrong == 0);
  }
}

}  // namespace fathom::test::warps_test
