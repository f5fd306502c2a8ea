// Compares the evaluators with each other (same bits on every instruction set and at every position in a block) and
// with the judge (ranges contain the values, surfaces agree).
#include "vm/interpret/evaluate.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "tests/support/catch.h"
#include "tests/support/judge/judge.h"
#include "tests/support/plain_lowering.h"
#include "tests/support/random/random_scene.h"
#include "tests/support/scaled_cases.h"
#include "tests/vm/number/float_bits.h"

namespace fathom::test::evaluate_test {
namespace {

using compiler::Kind;
using glm::dvec3;

constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

// Ordinary points. Every so often a coordinate is an extreme or special float.
Cloud spicy_cloud(Random& random, std::size_t count) {
  static const float kSpice[] = {0.f, -0.f, 1e-45f, -1e-39f, 1e-20f, 1e19f, -1e30f, 3.4e38f, kInf, -kInf, kNan};
  Cloud cloud;
  for (std::size_t i = 0; i < count; ++i) {
    float p[3];
    for (float& c : p) c = static_cast<float>(random.uniform(-2, 2));
    if (random.chance(0.2)) p[random.below(3)] = kSpice[random.below(11)];
    cloud.add(p[0], p[1], p[2]);
  }
  return cloud;
}

// Results of evaluate_surface, one word each: distance, gradient, convex, surface. [point][6]
std::vector<std::uint32_t> surface_bits(const vm::VerifiedProgram& program, vm::Points points, std::size_t count,
                                        vm::Workspace& workspace) {
  std::vector<float> d(count), gx(count), gy(count), gz(count), convex(count);
  std::vector<std::uint32_t> s(count), bits;
  vm::evaluate_surface(program, points, count, {d.data(), gx.data(), gy.data(), gz.data(), s.data(), convex.data()},
                       workspace);
  for (std::size_t i = 0; i < count; ++i) {
    for (float f : {d[i], gx[i], gy[i], gz[i], convex[i]}) bits.push_back(bits_of(f));
    bits.push_back(s[i]);
  }
  return bits;
}

compiler::Scene scene_of(std::uint64_t seed, bool mandelbulbs) {
  Random random(seed);
  GraphOptions options;
  options.mandelbulbs = mandelbulbs;
  return random_scene(random, options);
}

std::vector<Kind> all_primitives() {
  std::vector<Kind> kinds = primitive_kinds(compiler::Sort::Solid, true);
  for (const Kind kind : primitive_kinds(compiler::Sort::Outline, true)) kinds.push_back(kind);
  return kinds;
}

// Every primitive alone, then random graphs.
std::vector<compiler::Scene> scenes(int graphs) {
  std::vector<compiler::Scene> all;
  Random random(7);
  for (const Kind kind : all_primitives()) {
    all.push_back(single(kind, random_params(kind, random)));
  }
  for (int seed = 0; seed < graphs; ++seed) all.push_back(scene_of(static_cast<std::uint64_t>(seed), seed % 4 == 0));
  return all;
}

}  // namespace

TEST_CASE("one point at a time or many, on any instruction set: the same bits", "[interpret][evaluate][isa]") {
  const IsaGuard guard;
  vm::Workspace workspace;
  constexpr std::size_t kPoints = 300;
  const auto all = scenes(20);
  for (std::size_t n = 0; n < all.size(); ++n) {
    const vm::VerifiedProgram program = plain_lowering(all[n]);
    Random random(n);
    const Cloud cloud = spicy_cloud(random, kPoints);
    REQUIRE(vm::force_isa("scalar"));
    std::vector<std::uint32_t> distances, surfaces;
    for (std::size_t i = 0; i < kPoints; ++i) {
      distances.push_back(distance_bits(program, cloud.from(i), 1, workspace)[0]);
      const auto one = surface_bits(program, cloud.from(i), 1, workspace);
      surfaces.insert(surfaces.end(), one.begin(), one.end());
    }
    for (std::string_view isa : vm::available_isas()) {
      REQUIRE(vm::force_isa(isa));
      REQUIRE(vm::isa_name() == isa);
      for (std::size_t count = 1; count <= kPoints; count += n < 12 ? 1 : 7) {
        const std::size_t first = random.below(static_cast<int>(kPoints - count) + 1);
        INFO("scene " << n << ", " << isa << ", points " << first << " and " << count << " on");
        const auto many = distance_bits(program, cloud.from(first), count, workspace);
        CHECK(std::equal(many.begin(), many.end(), distances.begin() + static_cast<std::ptrdiff_t>(first)));
        if (count % 5 > 1) continue;
        const auto full = surface_bits(program, cloud.from(first), count, workspace);
        CHECK(std::equal(full.begin(), full.end(), surfaces.begin() + static_cast<std::ptrdiff_t>(6 * first)));
      }
    }
  }
}

TEST_CASE("the surface's distance is the distance, bit for bit", "[interpret][evaluate]") {
  vm::Workspace workspace;
  const auto all = scenes(60);
  for (std::size_t n = 0; n < all.size(); ++n) {
    const vm::VerifiedProgram program = plain_lowering(all[n]);
    Random random(n);
    const Cloud cloud = spicy_cloud(random, 500);
    const auto distances = distance_bits(program, cloud.from(0), cloud.size(), workspace);
    const auto surfaces = surface_bits(program, cloud.from(0), cloud.size(), workspace);
    int differ = 0;
    for (std::size_t i = 0; i < cloud.size(); ++i) differ += distances[i] != surfaces[6 * i];
    INFO("scene " << n);
    CHECK(differ == 0);
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const dvec3 p(cloud.x[i], cloud.y[i], cloud.z[i]);
      const double alone = vm::evaluate_distance(program, p, workspace);
      const double with = vm::evaluate_surface(program, p, workspace).distance;
      INFO("at " << p.x << ' ' << p.y << ' ' << p.z);
      if (std::isnan(alone)) {
        CHECK(std::isnan(with));
      } else {
        CHECK(std::bit_cast<std::uint64_t>(alone) == std::bit_cast<std::uint64_t>(with));
      }
    }
  }
}

TEST_CASE("a NaN point leaves its neighbours alone", "[interpret][evaluate]") {
  vm::Workspace workspace;
  constexpr std::size_t kPoints = 70;
  const auto all = scenes(10);
  for (std::size_t n = 0; n < all.size(); ++n) {
    const vm::VerifiedProgram program = plain_lowering(all[n]);
    Random random(n);
    Cloud cloud;
    for (std::size_t i = 0; i < kPoints; ++i) {
      const dvec3 p = random.in_box(2);
      cloud.add(static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z));
    }
    const auto before = surface_bits(program, cloud.from(0), kPoints, workspace);
    for (std::size_t poisoned = 0; poisoned < kPoints; ++poisoned) {
      Cloud with = cloud;
      with.x[poisoned] = with.y[poisoned] = with.z[poisoned] = kNan;
      auto after = surface_bits(program, with.from(0), kPoints, workspace);
      std::copy_n(before.begin() + static_cast<std::ptrdiff_t>(6 * poisoned), 6,
                  after.begin() + static_cast<std::ptrdiff_t>(6 * poisoned));
      INFO("scene " << n << ", point " << poisoned);
      CHECK(after == before);
    }
  }
}

TEST_CASE("no points: nothing is written", "[interpret][evaluate]") {
  vm::Workspace workspace;
  float untouched = 42;
  vm::evaluate_distance(primitive_program(Kind::Sphere, {1}), {nullptr, nullptr, nullptr}, 0, &untouched, workspace);
  CHECK(untouched == 42);
}

TEST_CASE("an unknown instruction set is refused", "[interpret][evaluate][isa]") {
  const IsaGuard guard;
  CHECK_FALSE(vm::force_isa("z80"));
  CHECK(vm::isa_name() == guard.before);
  const auto isas = vm::available_isas();
  CHECK(vm::isa_name() == guard.before);
  CHECK(std::find(isas.begin(), isas.end(), "scalar") != isas.end());
  CHECK(std::find(isas.begin(), isas.end(), guard.before) != isas.end());
}

namespace {

enum class Judged { No, Yes };  // Yes: also compare with the judge, which takes most of the time

// Checks that ranges over boxes contain sampled values: 20 boxes in each of `count` primitives and graphs, `points`
// samples per box. Returns the number of samples.
long check_ranges(std::uint64_t first_seed, std::uint64_t count, int points, Judged judged) {
  vm::Workspace workspace;
  const double sides[] = {0, 1e-9, 1e-3, 0.05, 0.3, 1, 4};
  const std::vector<Kind> kinds = all_primitives();
  long samples = 0;
  for (std::uint64_t seed = first_seed; seed < first_seed + count; ++seed) {
    Random random(seed);
    const bool primitive = seed % 3 == 0;
    const Kind kind = kinds[static_cast<std::size_t>(random.below(static_cast<int>(kinds.size())))];
    const compiler::Scene scene =
        primitive ? single(kind, random_params(kind, random)) : scene_of(seed, seed % 7 == 0);
    const vm::VerifiedProgram program = plain_lowering(scene);
    for (int box = 0; box < 20; ++box) {
      const dvec3 side = {sides[random.below(7)], sides[random.below(7)], sides[random.below(7)]};
      const dvec3 lo = random.in_box(2), hi = lo + side;
      const vm::Range range = vm::evaluate_range(program, lo, hi, workspace);
      INFO((primitive ? "primitive, seed " : "graph, seed ") << seed << ", box " << box);
      REQUIRE(range.lo <= range.hi);
      for (int i = 0; i < points; ++i, ++samples) {
        dvec3 p;
        for (int axis = 0; axis < 3; ++axis) {
          const double t = random.chance(0.3) ? random.below(2) : random.uniform(0, 1);
          p[axis] = std::clamp(lo[axis] + t * side[axis], lo[axis], hi[axis]);
        }
        const double value = vm::evaluate_distance(program, p, workspace);
        if (!(value >= range.lo && value <= range.hi)) {
          FAIL_CHECK(value << " not in " << range.lo << " .. " << range.hi);
        }
        if (judged == Judged::No) continue;
        const double truth = judge_distance(scene.graph, scene.root, p);
        const double slack = 1e-12 * std::max(1.0, std::abs(truth));  // for the judge's rounding errors
        if (!(truth >= range.lo - slack && truth <= range.hi + slack)) {
          FAIL_CHECK("judged " << truth << " not in " << range.lo << " .. " << range.hi << " at " << p.x << ' ' << p.y
                               << ' ' << p.z);
        }
      }
    }
  }
  return samples;
}

}  // namespace

TEST_CASE("ranges contain every value in their box", "[interpret][evaluate][range]") {
  CHECK(check_ranges(0, scaled_cases(500), 30, Judged::Yes) >= scaled_cases(300000));
}

TEST_CASE("ranges contain every one of a hundred million values in their boxes", "[nightly][.]") {
  CHECK(check_ranges(1700, 50000, 100, Judged::No) >= 100000000);
}

TEST_CASE("ranges of small boxes are narrow", "[interpret][evaluate][range]") {
  vm::Workspace workspace;
  int boxes = 0, narrow = 0;
  for (int seed = 0; seed < scaled_cases(500); ++seed) {
    Random random(seed);
    const vm::VerifiedProgram program = plain_lowering(scene_of(seed, false));
    for (int i = 0; i < 10; ++i, ++boxes) {
      const dvec3 lo = random.in_box(2);
      const vm::Range range = vm::evaluate_range(program, lo, lo + 1e-6, workspace);
      narrow += range.hi - range.lo <= 1e-3;
    }
  }
  INFO(narrow << " of " << boxes);
  CHECK(narrow >= 0.98 * boxes);
}

TEST_CASE("ranges of unbounded boxes are ranges", "[interpret][evaluate][range]") {
  vm::Workspace workspace;
  const double inf = std::numeric_limits<double>::infinity();
  const auto all = scenes(30);
  for (std::size_t n = 0; n < all.size(); ++n) {
    const vm::VerifiedProgram program = plain_lowering(all[n]);
    INFO("scene " << n);
    const double there = judge_distance(all[n].graph, all[n].root, {0.5, 0.25, -0.5});
    for (const dvec3& hi : {dvec3(inf), dvec3(1, inf, 1), dvec3(1e200)}) {
      const vm::Range range = vm::evaluate_range(program, -hi, hi, workspace);
      CHECK(range.lo <= there);
      CHECK(range.hi >= there);
    }
  }
}

TEST_CASE("the surface is the one the judge names, away from ties", "[interpret][evaluate][surface]") {
  vm::Workspace workspace;
  int named = 0;
  for (int seed = 0; seed < scaled_cases(300); ++seed) {
    const compiler::Scene scene = scene_of(seed, false);
    const vm::VerifiedProgram program = plain_lowering(scene);
    Random random(seed);
    for (int i = 0; i < 40; ++i) {
      const dvec3 p = random.in_box(3);
      const Verdict verdict = judge(scene.graph, scene.root, p);
      INFO("seed " << seed << ", at " << p.x << ' ' << p.y << ' ' << p.z << ", margin " << verdict.margin);
      if (verdict.margin > 1e-9) {
        ++named;
        CHECK(vm::evaluate_surface(program, p, workspace).surface == verdict.surface);
      }
      if (verdict.margin > 1e-3) {
        const float x = static_cast<float>(p.x), y = static_cast<float>(p.y), z = static_cast<float>(p.z);
        CHECK(surface_bits(program, {&x, &y, &z}, 1, workspace)[5] == verdict.surface);
      }
    }
  }
  CHECK(named > scaled_cases(10000));
}

// Regression: a Mandelbulb's point exactly at the bailout went on iterating when a neighbouring lane did, and
// overflowing derivatives became NaN.
TEST_CASE("a Mandelbulb's points do not disturb each other, and have finite gradients", "[interpret][evaluate]") {
  const IsaGuard guard;
  compiler::Scene scene;
  scene.root = scene.graph.add(compiler::Kind::Mandelbulb, std::vector<double>{8, 256, 4, 0.001}, {});
  const vm::VerifiedProgram program = plain_lowering(scene);
  vm::Workspace workspace;
  for (std::string_view isa : vm::available_isas()) {
    REQUIRE(vm::force_isa(isa));
    const float x[2] = {0, 0.1f}, y[2] = {4, 1}, z[2] = {0, 0};
    float alone, together[2];
    vm::evaluate_distance(program, {x, y, z}, 1, &alone, workspace);
    vm::evaluate_distance(program, {x, y, z}, 2, together, workspace);
    CHECK(alone == together[0]);
    for (int i = 0; i < 2000; ++i) {
      const float px = 0, py = -1.104f + 7.7e-5f * static_cast<float>(i), pz = 0;
      float d, gx, gy, gz;
      std::uint32_t surface;
      vm::evaluate_surface(program, {&px, &py, &pz}, 1, {&d, &gx, &gy, &gz, &surface}, workspace);
      if (!(std::isfinite(gx) && std::isfinite(gy) && std::isfinite(gz))) FAIL("gradient at y = " << py);
    }
  }
}

}  // namespace fathom::test::evaluate_test
