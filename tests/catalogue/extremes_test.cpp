// The adversarial catalogue, rows F7, F13 and F14: the Mandelbulb where its formula is undefined, coordinates too
// small for normal floats, and NaNs. docs/explanation/accuracy.md lists all rows.
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "runtime/render.h"
#include "tests/catalogue/naive.h"
#include "tests/catalogue/solids.h"
#include "tests/support/catch.h"
#include "tests/support/compiled.h"
#include "tests/support/not_run.h"
#include "tests/support/plain_lowering.h"
#include "tests/vm/number/float_bits.h"
#ifdef __SSE2__
#include <immintrin.h>
#endif

namespace fathom::catalogue::extremes_test {
namespace {

using test::compiled_objects;

std::string mandelbulb(int power, int iterations, const char* detail) {
  return R"({"type": "mandelbulb", "power": )" + std::to_string(power) + R"(, "iterations": )" +
         std::to_string(iterations) + R"(, "detail": )" + detail + "}";
}

// Number of steps after which the orbit leaves the ball of radius 4, or 200 if the orbit stays. White and Nylander's
// formula, by angles, about the y axis.
int escape_time(const Vec3& p, int power) {
  Vec3 w = p;
  for (int i = 0; i < 200; ++i) {
    const long double r = glm::length(w);
    if (r > 4) return i;
    const long double polar = r > 0 ? power * std::acos(std::clamp(w.y / r, -1.0L, 1.0L)) : 0;
    const long double azimuth = power * std::atan2(w.x, w.z), grown = std::pow(r, static_cast<long double>(power));
    w = p + grown * Vec3(std::sin(polar) * std::sin(azimuth), std::cos(polar), std::sin(polar) * std::cos(azimuth));
  }
  return 200;
}

bool finite(const vm::SurfaceValue& v) { return std::isfinite(v.distance) && std::isfinite(glm::length(v.gradient)); }

vm::SurfaceValue in_float(const compiler::CompiledScene& scene, glm::dvec3 p, vm::Workspace& workspace) {
  const float x = static_cast<float>(p.x), y = static_cast<float>(p.y), z = static_cast<float>(p.z);
  float d, gx, gy, gz;
  std::uint32_t surface;
  vm::evaluate_surface(scene.surface, {&x, &y, &z}, 1, {&d, &gx, &gy, &gz, &surface}, workspace);
  return {d, {gx, gy, gz}, surface};
}

}  // namespace

TEST_CASE("F7: the Mandelbulb at its centre, on its axis and within is a number", "[catalogue]") {
  vm::Workspace workspace;
  Random random(1);
  for (const int power : {2, 8}) {
    for (const int iterations : {1, 2, 8, 64}) {
      const auto scene = compiled_objects(mandelbulb(power, iterations, "0.001"));
      INFO("power " << power << ", " << iterations << " iterations");
      std::vector<glm::dvec3> points = {{0, 0, 0}, {0, 0, 1e-30}, {1e-20, 1e-20, 0}};
      for (int i = -50; i <= 50; ++i) points.push_back({0, i / 25.0, 0});
      for (int i = 0; i < 500; ++i) points.push_back(to_float(random.uniform(0, 1.2) * random.direction()));
      for (const glm::dvec3& p : points) {
        INFO(p.x << ' ' << p.y << ' ' << p.z);
        CHECK(finite(vm::evaluate_surface(scene.surface, p, workspace)));
        CHECK(finite(in_float(scene, p, workspace)));
      }
      CHECK(vm::evaluate_distance(scene.distance, glm::dvec3(0), workspace) <= 0);
    }
  }
}

namespace {

struct Orbits {
  // Orbits that stay for two hundred steps, and orbits that leave within twelve. Later departures are chaotic and
  // differ in double.
  int stay = 0, spawn_ray = 0;
  // Points with a positive value among those that stay, and with a negative value among those that leave.
  int shown_outside = 0, shown_inside = 0;
};

Orbits orbits(int power) {
  const auto blurred = compiled_objects(mandelbulb(power, 64, "0.001"));
  const auto sharp = compiled_objects(mandelbulb(power, 64, "0"));
  vm::Workspace workspace;
  Random random(2);
  Orbits found;
  for (int i = 0; i < 5000; ++i) {
    const glm::dvec3 p(random.uniform(-1.25, 1.25), random.uniform(-1.25, 1.25), random.uniform(-1.25, 1.25));
    const int time = escape_time(Vec3(p), power);
    if (time == 200) {
      ++found.stay;
      found.shown_outside += vm::evaluate_distance(blurred.distance, p, workspace) >= 0;
    } else if (time <= 12) {
      ++found.spawn_ray;
      found.shown_inside += vm::evaluate_distance(sharp.distance, p, workspace) <= 0;
    }
  }
  return found;
}

}  // namespace

TEST_CASE("F7: what leaves is outside the Mandelbulb", "[catalogue]") {
  for (const int power : {2, 8}) {
    const Orbits found = orbits(power);
    INFO("power " << power << ": " << found.stay << " stay, " << found.spawn_ray << " leave");
    CHECK(found.spawn_ray > 2000);
    CHECK(found.shown_inside == 0);
  }
}

// Not met: if an orbit settles on a cycle whose last step is farther than 1 from the origin, the logarithm in the
// estimate is positive and the derivative is small.
TEST_CASE("F7: what stays is inside the Mandelbulb", "[unmet][.]") {
  for (const int power : {2, 8}) {
    const Orbits found = orbits(power);
    INFO("power " << power << ": " << found.stay << " stay, " << found.spawn_ray << " leave");
    CHECK(found.stay > 200);
    CHECK(found.shown_outside == 0);
  }
}

TEST_CASE("F7: powers and iterations that a Mandelbulb cannot have", "[catalogue]") {
  CHECK(codes_of(R"({"type": "mandelbulb", "power": 2.5})") == "E0101");
  CHECK(codes_of(R"({"type": "mandelbulb", "power": 1})") == "E0302");
  CHECK(codes_of(R"({"type": "mandelbulb", "power": 8, "iterations": 0})") == "E0301");
  CHECK(codes_of(R"({"type": "mandelbulb", "power": 8, "bailout": 0.5})") == "E0302");
  CHECK(codes_of(mandelbulb(8, 8, "0.001")) == "");
}

namespace {

const char* const kSmall[] = {
    R"({"type": "sphere", "radius": 1})",
    R"({"type": "box", "half_size": [0.75, 0.5, 1]})",
    R"({"type": "torus", "major_radius": 1, "minor_radius": 0.25})",
    R"({"type": "cone", "bottom_radius": 1, "top_radius": 0, "half_height": 0.75})",
    R"({"type": "round_cone", "bottom_radius": 1, "top_radius": 0.25, "height": 1})",
    R"({"type": "smooth_union", "k": 0.25, "of": [{"type": "sphere", "radius": 1}, {"type": "box", "half_size": [1, 1, 1]}]})",
    R"({"type": "twist", "turn": 90, "of": {"type": "box", "half_size": [0.5, 1, 0.25]}})",
    R"({"type": "mandelbulb", "power": 8})",
    R"J({"type": "expression", "formula": "length(x, y, z) - 1 + 0.1*sin(5*x)"})J"};

// Makes the processor flush denormal numbers to zero, as a render's worker might. The destructor restores the state.
class FlushToZero {
 public:
#ifdef __SSE2__
  FlushToZero() : before_(_mm_getcsr()) { _mm_setcsr(before_ | 0x8040u); }
  ~FlushToZero() { _mm_setcsr(before_); }

 private:
  unsigned before_;
#endif
};

std::vector<float> distances(const compiler::CompiledScene& scene, const test::Cloud& cloud,
                             vm::Workspace& workspace) {
  std::vector<float> d(cloud.size());
  vm::evaluate_distance(scene.distance, cloud.from(0), cloud.size(), d.data(), workspace);
  return d;
}

float largest_difference(const std::vector<float>& a, const std::vector<float>& b) {
  float largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
  return largest;
}

}  // namespace

// Denormal coordinates next to coordinates of size 1 act as zeros, whether or not the processor flushes them to zero.
TEST_CASE("F13: denormal coordinates change nothing", "[catalogue]") {
  vm::Workspace workspace;
  const float tiny[] = {0, 1e-45f, -3e-42f, 1e-39f, 1e-38f};
  const float ordinary[] = {0, 0.25f, -1};
  for (const char* node : kSmall) {
    const auto scene = compiled_objects(node);
    INFO(node);
    test::Cloud denormal, zero;
    for (int i = 0; i < 5 * 5 * 3; ++i) {
      denormal.add(tiny[i % 5], ordinary[i / 25], tiny[i / 5 % 5]);
      zero.add(0, ordinary[i / 25], 0);
      const glm::dvec3 p(denormal.x.back(), denormal.y.back(), denormal.z.back());
      CHECK(finite(in_float(scene, p, workspace)));
      CHECK(finite(vm::evaluate_surface(scene.surface, p, workspace)));
    }
    const std::vector<float> expected = distances(scene, zero, workspace);
    CHECK(largest_difference(distances(scene, denormal, workspace), expected) <= 1e-30f);
    [[maybe_unused]] const FlushToZero flush;
    CHECK(largest_difference(distances(scene, denormal, workspace), expected) <= 1e-30f);
  }
#ifndef __SSE2__
  test::not_run("only x86 is made to flush denormal numbers to zero");
#endif
}

#ifdef __SSE2__
TEST_CASE("F13: the floating-point state is left as it was", "[catalogue]") {
  const unsigned before = _mm_getcsr() & ~0x3fu;  // without the flags of past exceptions
  const auto scene = compiled_objects(kSmall[0]);
  const std::vector<Ray> rays = rays_at_sphere(100, 5);
  march(make_field(scene), rays);
  RenderOptions options;
  options.width = options.height = 8;
  options.spp = 1;
  options.threads = 2;
  render(scene, options);
  CHECK((_mm_getcsr() & ~0x3fu) == before);
}
#endif

// One rule for NaN operands: min(a, b) is a < b ? a : b, in float on every instruction set and in double
// (vm/number/number-inl.h).
TEST_CASE("F14: min and max of what is no number have one rule on every evaluator", "[catalogue]") {
  const test::IsaGuard guard;
  vm::Workspace workspace;
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  const double values[] = {nan, -inf, -1, -0.0, 0.0, 1, inf};
  for (const vm::Opcode opcode : {vm::Opcode::Min, vm::Opcode::Max}) {
    vm::Program code;
    code.append(vm::Opcode::X, 0, {}, {});
    code.append(vm::Opcode::Y, 0, {}, {});
    code.append(opcode, 0, {}, {});
    const vm::VerifiedProgram program = test::verified(std::move(code));
    for (const double a : values) {
      for (const double b : values) {
        const bool first = opcode == vm::Opcode::Min ? a < b : a > b;
        const double truth = first ? a : b;
        const auto same = [&](double found) { return std::isnan(truth) ? std::isnan(found) : found == truth; };
        INFO((opcode == vm::Opcode::Min ? "min " : "max ") << a << ' ' << b);
        CHECK(same(vm::evaluate_distance(program, glm::dvec3(a, b, 0), workspace)));
        for (const std::string_view isa : vm::available_isas()) {
          REQUIRE(vm::force_isa(isa));
          const float x = static_cast<float>(a), y = static_cast<float>(b), z = 0;
          float d;
          vm::evaluate_distance(program, {&x, &y, &z}, 1, &d, workspace);
          INFO(isa);
          CHECK(same(static_cast<double>(d)));
        }
      }
    }
  }
}

// A formula without a value along some rays: these rays are invalid and counted as invalid, not as misses.
TEST_CASE("F14: rays through what has no value are invalid, their neighbours are not", "[catalogue]") {
  const auto scene = compiled_objects(R"J({"type": "expression", "formula": "length(x, y, z) - 1 + 0*sqrt(1.5 - x)",
      "half_size": [4, 4, 4]})J");
  std::vector<Ray> rays;
  for (const double x : {0.5, 2.0, 0.25, 3.0}) rays.push_back({{x, 0, 6}, {0, 0, -1}});
  const MarchResult result = march(make_field(scene), rays);
  for (const std::size_t i : {0u, 2u}) {
    REQUIRE(result.ray_hits[i].status == RayHit::Status::Hit);
    CHECK(result.ray_hits[i].t ==
          Approx(static_cast<double>(6 - std::sqrt(1 - rays[i].origin.x * rays[i].origin.x))));
  }
  for (const std::size_t i : {1u, 3u}) CHECK(result.ray_hits[i].status == RayHit::Status::Invalid);
  CHECK(result.counters.invalid == 2);
}

}  // namespace fathom::catalogue::extremes_test
