// The adversarial catalogue, rows F5 and F6: blends of extreme widths, shells of shells. docs/explanation/accuracy.md
// lists all rows.
#include <cmath>
#include <string>
#include <vector>

#include "tests/catalogue/closed_forms.h"
#include "tests/catalogue/naive.h"
#include "tests/support/catch.h"
#include "tests/support/compiled.h"
#include "tests/vm/number/float_bits.h"

namespace fathom::catalogue::combinators_test {
namespace {

using test::compiled_objects;

const std::string kBallAndBox = R"([{"type": "sphere", "radius": 1}, {"type": "box", "half_size": [0.5, 1.5, 1]}])";

std::string blend(const std::string& kind, const std::string& k, const std::string& of) {
  return R"({"type": "smooth_)" + kind + R"(", "k": )" + k + R"(, "of": )" + of + "}";
}

test::Cloud cloud_around(int count) {
  Random random(1);
  test::Cloud cloud;
  const auto coordinate = [&] { return static_cast<float>(random.uniform(-2, 2)); };
  for (int i = 0; i < count; ++i) cloud.add(coordinate(), i % 7 ? coordinate() : -0.f, coordinate());
  return cloud;
}

long double ball(const glm::dvec3& p) { return std::hypot<long double>(p.x, p.y, p.z) - 1; }

long double beam(const glm::dvec3& p) {
  const long double x = std::abs(p.x) - 0.5L, y = std::abs(p.y) - 1.5L, z = std::abs(p.z) - 1;
  return std::hypot(std::max(x, 0.0L), std::max(y, 0.0L), std::max(z, 0.0L)) + std::min(std::max({x, y, z}), 0.0L);
}

// Quilez's quadratic blend. The documentation defines `k` as the width of this blend.
long double blended(long double a, long double b, long double k) {
  const long double h = std::max(k - std::abs(a - b), 0.0L) / k;
  return std::min(a, b) - h * h * k / 4;
}

}  // namespace

// Tests of the machine's opcodes alone: tests/vm/number/operators_test.cpp.
TEST_CASE("F5: a blend of width 0 is the hard operator, bit for bit", "[catalogue]") {
  vm::Workspace workspace;
  const test::Cloud cloud = cloud_around(5000);
  for (const std::string kind : {"union", "intersection", "subtraction"}) {
    const auto soft = compiled_objects(blend(kind, "0", kBallAndBox));
    const auto hard = compiled_objects(R"({"type": ")" + kind + R"(", "of": )" + kBallAndBox + "}");
    INFO(kind);
    CHECK(test::distance_bits(soft.distance, cloud.from(0), cloud.size(), workspace) ==
          test::distance_bits(hard.distance, cloud.from(0), cloud.size(), workspace));
    CHECK(codes_of(blend(kind, "-0.25", kBallAndBox)) == "E0301");
  }
}

TEST_CASE("F5: blends of any width, the widest too, have the value that defines them", "[catalogue]") {
  vm::Workspace workspace;
  Random random(2);
  for (const double k : {1e-30, 1e-12, 1e-3, 0.25, 1.0, 1e3, 1e6}) {
    char text[32];
    std::snprintf(text, sizeof text, "%.17g", k);
    const auto scene = compiled_objects(blend("union", text, kBallAndBox));
    double wide = 0;
    int finite = 0;
    for (int i = 0; i < 2000; ++i) {
      const glm::dvec3 p(random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-2, 2));
      const vm::SurfaceValue value = vm::evaluate_surface(scene.surface, p, workspace);
      wide = std::max(wide, std::abs(static_cast<double>(value.distance - blended(ball(p), beam(p), k))));
      finite += std::isfinite(value.distance) && glm::length(value.gradient) <= 1 + 1e-9;
    }
    INFO("k " << k);
    CHECK(wide <= 1e-14 * std::max(1.0, k));
    CHECK(finite == 2000);
  }
}

// Two copies of one solid: the surface moves by k/4 everywhere, and the gradient is the solid's.
TEST_CASE("F5: where the operands of a blend are equal", "[catalogue]") {
  const std::string twice = R"([{"type": "sphere", "radius": 1}, {"type": "sphere", "radius": 1}])";
  vm::Workspace workspace;
  Random random(3);
  for (const auto& [kind, sign] : {std::pair{"union", -1.0}, {"intersection", 1.0}}) {
    const auto scene = compiled_objects(blend(kind, "0.5", twice));
    INFO(kind);
    for (int i = 0; i < 1000; ++i) {
      const glm::dvec3 p(random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-2, 2));
      const vm::SurfaceValue value = vm::evaluate_surface(scene.surface, p, workspace);
      CHECK(std::abs(static_cast<double>(value.distance - (ball(p) + sign * 0.125L))) <= 1e-14);
      CHECK(glm::length(value.gradient - glm::normalize(p)) <= 1e-12);
    }
  }
}

namespace {

// Checks concentric shells with the given radii in descending order: solid between the first and the second, the
// third and the fourth ... The rays start outside, and in the middle of every wall and every gap.
void expect_shells(const std::string& node, const std::vector<double>& radii) {
  const auto scene = compiled_objects(node);
  Random random(4);
  std::vector<Ray> rays;
  for (std::size_t i = 0; i <= radii.size(); ++i) {
    const double outer = i == 0 ? 2 : radii[i - 1], inner = i < radii.size() ? radii[i] : 0;
    for (int n = 0; n < 2000; ++n) {
      rays.push_back({to_float((outer + inner) / 2 * random.direction()), to_float(random.direction())});
    }
  }
  const Truth first = [&](const Ray& ray) {
    Real nearest = -1;
    for (const double radius : radii) {
      const Span span = sphere_span(ray, {0, 0, 0}, radius);
      if (!span.empty() && span.end > 0) nearest = nearer(nearest, span.begin > 0 ? span.begin : span.end);
    }
    return nearest;
  };
  INFO(node);
  const Judgement found = judge(march(make_field(scene), rays), rays, first);
  CHECK(found.wrong() == 0);
  CHECK(found.exhausted == 0);
  CHECK(found.p99() <= 1e-5);
}

std::string shell(const std::string& thickness, const std::string& of) {
  return R"({"type": "onion", "thickness": )" + thickness + R"(, "of": )" + of + "}";
}

}  // namespace

TEST_CASE("F6: a shell of a shell, and of what is hollow", "[catalogue]") {
  const std::string solid = R"({"type": "sphere", "radius": 1})";
  const std::string hollow =
      R"({"type": "subtraction", "of": [)" + solid + R"(, {"type": "sphere", "radius": 0.5}]})";
  expect_shells(shell("0.0625", shell("0.25", solid)), {1.3125, 1.1875, 0.8125, 0.6875});
  expect_shells(shell("0.0625", hollow), {1.0625, 0.9375, 0.5625, 0.4375});
  // The shell is thicker than the ball is deep, so the inner surface vanishes.
  expect_shells(shell("0.25", shell("1", solid)), {2.25, 1.75, 0.25});
}

TEST_CASE("F6: rounding inwards is refused, cuts that leave nothing are empty", "[catalogue]") {
  CHECK(codes_of(R"({"type": "round", "radius": -2, "of": {"type": "sphere", "radius": 1}})") == "E0301");
  CHECK(codes_of(R"({"type": "onion", "thickness": -0.25, "of": {"type": "sphere", "radius": 1}})") == "E0301");
  const auto nothing = compiled_objects(R"({"type": "subtraction", "of": [{"type": "sphere", "radius": 1},
      {"type": "round", "radius": 0.25, "of": {"type": "sphere", "radius": 1}}]})");
  const std::vector<Ray> rays = rays_at_sphere(5000, 5);
  const MarchResult result = march(make_field(nothing), rays);
  CHECK(result.counters.hits == 0);
  CHECK(result.counters.invalid + result.counters.exhausted == 0);
}

}  // namespace fathom::catalogue::combinators_test
