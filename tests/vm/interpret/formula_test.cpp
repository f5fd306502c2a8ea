// Random formulas on every evaluator: same bits on every instruction set, ranges that contain the values, gradients
// that match difference quotients, bounds of slope and float error that hold.
#include "tests/vm/interpret/formula.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/support/catch.h"
#include "tests/support/scaled_cases.h"
#include "tests/vm/number/float_bits.h"
#include "vm/range/slope.h"

namespace fathom::test::formula_test {
namespace {

using glm::dvec3;
using vm::Opcode;

glm::vec3 float_point(Random& random, dvec3 lo, dvec3 hi) {
  glm::vec3 p;
  for (int axis = 0; axis < 3; ++axis) {
    p[axis] = std::clamp(static_cast<float>(random.uniform(lo[axis], hi[axis])), static_cast<float>(lo[axis]),
                         static_cast<float>(hi[axis]));
  }
  return p;
}

// Random box with corners at floats and sides from 0 to 4.
void random_box(Random& random, dvec3& lo, dvec3& hi) {
  static const double kSides[] = {0, 1e-3, 0.05, 0.3, 1, 4};
  for (int axis = 0; axis < 3; ++axis) {
    lo[axis] = random.chance(0.2) ? random.below(5) - 2 : static_cast<float>(random.uniform(-3, 3));
    hi[axis] = static_cast<float>(lo[axis] + kSides[random.below(6)]);
  }
}

struct BoundCounts {
  int boxes = 0, lipschitz = 0, error = 0;  // numbers of boxes; with a finite Lipschitz constant; with a finite error
};

// Checks the bounds of a formula in a random box at random points.
void check_slope_bounds(const std::vector<Step>& steps, int seed, BoundCounts& counts) {
  vm::Workspace workspace;
  const vm::VerifiedProgram program = formula(steps);
  Random random(seed + 7);
  dvec3 lo, hi;
  random_box(random, lo, hi);
  const auto parts = subexpressions(steps);
  const vm::SlopeBound bound = vm::evaluate_slope(program, lo, hi, workspace);
  INFO("seed " << seed << ": " << text_of(steps) << " box " << lo.x << ' ' << lo.y << ' ' << lo.z << " to " << hi.x
               << ' ' << hi.y << ' ' << hi.z << ": lipschitz " << bound.lipschitz << ", error " << bound.float_error);
  REQUIRE(bound.lipschitz >= 0);
  REQUIRE(bound.float_error >= 0);
  ++counts.boxes, counts.lipschitz += std::isfinite(bound.lipschitz),
      counts.error += std::isfinite(bound.float_error);
  for (int i = 0; i < 12; ++i) {
    const glm::vec3 p = float_point(random, lo, hi), q = float_point(random, lo, hi);
    if (!defined_at(parts, dvec3(p), workspace) || !defined_at(parts, dvec3(q), workspace)) continue;
    const vm::SurfaceValue at = vm::evaluate_surface(program, dvec3(p), workspace);
    const double there = vm::evaluate_distance(program, dvec3(q), workspace);
    const float narrow = evaluate_float(program, p, workspace);
    INFO("at " << p.x << ' ' << p.y << ' ' << p.z << " value " << at.distance << ", in float " << narrow);
    CHECK((at.distance >= bound.value.lo && at.distance <= bound.value.hi));
    const double length = glm::length(at.gradient);
    CHECK(length <= bound.lipschitz * (1 + 1e-9) + 1e-12);
    const double change = std::abs(at.distance - there);
    if (std::isfinite(bound.lipschitz)) {
      CHECK(!(change > bound.lipschitz * glm::length(dvec3(p) - dvec3(q)) * (1 + 1e-9) + 1e-12));
    }
    if (std::isfinite(bound.float_error)) CHECK(std::abs(narrow - at.distance) <= bound.float_error);
  }
}

// Checks the bounds of formulas that `append` makes.
template <class Append>
BoundCounts check_random_bounds(const Append& append) {
  BoundCounts counts;
  for (int seed = 0; seed < scaled_cases(10000); ++seed) {
    Random random(seed);
    std::vector<Step> steps;
    append(random, steps);
    check_slope_bounds(steps, seed, counts);
  }
  WARN(counts.lipschitz << " and " << counts.error << " of " << counts.boxes
                        << " boxes have a finite slope and float error");
  return counts;
}

}  // namespace

TEST_CASE("formulas have the same bits on every instruction set", "[interpret][formula][isa]") {
  const IsaGuard guard;
  vm::Workspace workspace;
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    const auto steps = random_formula(seed);
    const vm::VerifiedProgram program = formula(steps);
    Random random(seed);
    constexpr std::size_t kCount = 67;
    std::vector<float> x(kCount), y(kCount), z(kCount), d(kCount), g[3], e(kCount);
    for (auto& axis : g) axis.resize(kCount);
    std::vector<std::uint32_t> surface(kCount), first;
    const float spice[] = {0.f,          -0.f, 1e-40f, 1e20f, -1e5f, 3e38f, std::numeric_limits<float>::infinity(),
                           std::nanf("")};
    for (std::size_t i = 0; i < kCount; ++i) {
      for (auto* axis : {&x, &y, &z}) {
        (*axis)[i] = random.chance(0.1) ? spice[random.below(8)] : static_cast<float>(random.uniform(-4, 4));
      }
    }
    for (std::string_view isa : vm::available_isas()) {
      REQUIRE(vm::force_isa(isa));
      vm::evaluate_distance(program, {x.data(), y.data(), z.data()}, kCount, e.data(), workspace);
      vm::evaluate_surface(program, {x.data(), y.data(), z.data()}, kCount,
                           {d.data(), g[0].data(), g[1].data(), g[2].data(), surface.data()}, workspace);
      std::vector<std::uint32_t> bits;
      for (const auto* values : {&e, &d, &g[0], &g[1], &g[2]}) {
        std::transform(values->begin(), values->end(), std::back_inserter(bits), bits_of);
      }
      if (first.empty()) first = bits;
      INFO("seed " << seed << " on " << isa << ": " << text_of(steps));
      CHECK(bits == first);
      CHECK(std::equal(bits.begin(), bits.begin() + kCount, bits.begin() + kCount));
    }
  }
}

TEST_CASE("ranges of formulas contain their values", "[interpret][formula][range]") {
  vm::Workspace workspace;
  int finite = 0, boxes = 0;
  for (int seed = 0; seed < scaled_cases(20000); ++seed) {
    const auto steps = random_formula(seed);
    const vm::VerifiedProgram program = formula(steps);
    Random random(seed);
    dvec3 lo, hi;
    random_box(random, lo, hi);
    const auto parts = subexpressions(steps);
    const vm::Range range = vm::evaluate_range(program, lo, hi, workspace);
    INFO("seed " << seed << ": " << text_of(steps));
    REQUIRE(range.lo <= range.hi);
    ++boxes;
    finite += std::isfinite(range.hi - range.lo);
    for (int i = 0; i < 20; ++i) {
      const dvec3 p(float_point(random, lo, hi));
      const double value = vm::evaluate_distance(program, p, workspace);
      if (!defined_at(parts, p, workspace)) continue;
      if (!(value >= range.lo && value <= range.hi)) {
        FAIL_CHECK(value << " not in " << range.lo << " .. " << range.hi << " at " << p.x << ' ' << p.y << ' '
                         << p.z);
      }
    }
  }
  CHECK(finite > boxes / 2);
}

TEST_CASE("gradients of formulas match differences", "[interpret][formula][gradient]") {
  vm::Workspace workspace;
  int compared = 0;
  for (std::uint64_t seed = 0; seed < 6000; ++seed) {
    const auto steps = random_formula(seed);
    const vm::VerifiedProgram program = formula(steps);
    Random random(seed);
    const dvec3 p = random.in_box(3);
    const vm::SlopeBound near = vm::evaluate_slope(program, p - 1e-4, p + 1e-4, workspace);
    const vm::SurfaceValue surface = vm::evaluate_surface(program, p, workspace);
    for (int axis = 0; axis < 3; ++axis) CHECK(std::isfinite(surface.gradient[axis]));
    if (!(near.lipschitz < 1e3)) continue;  // jumps and poles have no difference quotient to compare with
    for (int axis = 0; axis < 3; ++axis) {
      double d[3];
      for (int i = 0; i < 3; ++i) {
        dvec3 q = p;
        q[axis] += (i - 1) * 1e-5;
        d[i] = vm::evaluate_distance(program, q, workspace);
      }
      const double left = (d[1] - d[0]) / 1e-5, right = (d[2] - d[1]) / 1e-5;
      if (!(std::abs(left - right) < 1e-2 * (1 + std::abs(left)))) continue;  // a kink
      ++compared;
      INFO("seed " << seed << ", axis " << axis << ": " << text_of(steps));
      CHECK(std::abs(surface.gradient[axis] - (left + right) / 2) <= 2e-2 * (1 + std::abs(left)));
    }
  }
  CHECK(compared > 5000);
}

TEST_CASE("slope bounds hold: value, gradient, float error", "[interpret][formula][slope]") {
  BoundCounts counts;
  for (int seed = 0; seed < scaled_cases(20000); ++seed) check_slope_bounds(random_formula(seed), seed, counts);
  WARN(counts.lipschitz << " and " << counts.error << " of " << counts.boxes
                        << " boxes have a finite slope and float error");
  CHECK(counts.lipschitz > counts.boxes / 4);
}

// The exponentials of such formulas underflow and overflow in float.
TEST_CASE("bounds of sums of exponentials hold", "[interpret][formula][slope]") {
  const BoundCounts counts = check_random_bounds(
      [](Random& random, std::vector<Step>& steps) { append_exponentials(random, 1 + random.below(4), steps); });
  CHECK(counts.lipschitz > counts.boxes * 0.99);  // without one: exponentials that leave the range of double
  CHECK(counts.error > counts.boxes * 2 / 3);
}

TEST_CASE("bounds of smooth unions near poles hold", "[interpret][formula][slope]") {
  const BoundCounts counts = check_random_bounds(append_pole);
  CHECK(counts.lipschitz > counts.boxes * 2 / 3);
}

TEST_CASE("bounds of repeated cells and sectors hold", "[interpret][formula][slope]") {
  const BoundCounts counts = check_random_bounds(append_cells);
  CHECK(counts.lipschitz > counts.boxes / 2);
}

TEST_CASE("repeated cells have a bound if they are equal on both sides of their border",
          "[interpret][formula][slope]") {
  vm::Workspace workspace;
  const auto bound = [&](double period, double shift, Opcode even) {
    return vm::evaluate_slope(formula({{Opcode::X},
                                       {Opcode::Constant, {period}},
                                       {Opcode::Modulo},
                                       {Opcode::Offset, {shift}},
                                       {even},
                                       {Opcode::Y},
                                       {Opcode::Square},
                                       {Opcode::Add},
                                       {Opcode::Sqrt}}),
                              dvec3(-3), dvec3(3), workspace);
  };
  CHECK(bound(0.9, 0.45, Opcode::Square).lipschitz <= 1 + 1e-9);
  CHECK(bound(0.9, 0.45, Opcode::Square).float_error < 1e-2);  // the root at 0
  CHECK(!std::isfinite(bound(0.9, 0.4, Opcode::Square).lipschitz));
  CHECK(!std::isfinite(bound(0.9, 0.45 + 1e-9, Opcode::Square).lipschitz));
  CHECK(!std::isfinite(bound(0.9, 0.45, Opcode::Sin).lipschitz));
}

TEST_CASE("jumps that only seem to close, and numbers beyond those of float, have no bound",
          "[interpret][formula][slope]") {
  vm::Workspace workspace;
  const auto bound = [&](double period, const std::vector<Step>& steps) {
    std::vector<Step> all = {{Opcode::X}, {Opcode::Constant, {period}}, {Opcode::Modulo}};
    all.insert(all.end(), steps.begin(), steps.end());
    return vm::evaluate_slope(formula(all), dvec3(-2), dvec3(2), workspace);
  };
  // Far from 0 the doubles on both sides of the jump are nearly equal.
  CHECK(!std::isfinite(bound(1, {{Opcode::Offset, {-2e14}}, {Opcode::Abs}, {Opcode::Offset, {2e14}}}).lipschitz));
  // The number overflows or underflows between the jump and the end.
  CHECK(!(bound(1, {{Opcode::Offset, {0.5}}, {Opcode::Scale, {3e38}}, {Opcode::Scale, {100}}, {Opcode::Abs}})
              .float_error < 1e30));
  CHECK(bound(1, {{Opcode::Offset, {0.5}},
                  {Opcode::Scale, {0x1p-126}},
                  {Opcode::Scale, {0x1p-20}},
                  {Opcode::Abs},
                  {Opcode::Scale, {0x1p100}},
                  {Opcode::Scale, {0x1p46}}})
            .float_error > 0.025);
  // Divided, and repeated the other way.
  CHECK(bound(1, {{Opcode::Constant, {2}}, {Opcode::Divide}, {Opcode::Offset, {0.25}}, {Opcode::Abs}}).lipschitz <=
        0.5 + 1e-9);
  CHECK(bound(-1, {{Opcode::Offset, {-0.5}}, {Opcode::Abs}}).lipschitz <= 1 + 1e-9);
}

// The pole of 0.1 / x is a wall on both sides of which the quotient's part of the union vanishes.
TEST_CASE("a smooth union has a bound where an operand is infinite, unless only on one side",
          "[interpret][formula][slope]") {
  vm::Workspace workspace;
  const auto bound = [&](std::vector<Step> quotient) {
    quotient.insert(quotient.begin(), {{Opcode::Constant, {0.1}}, {Opcode::X}, {Opcode::Divide}});
    for (const Step& step :
         {Step{Opcode::Scale, {-30}}, Step{Opcode::Exp}, Step{Opcode::Y}, Step{Opcode::Scale, {-30}},
          Step{Opcode::Exp}, Step{Opcode::Add}, Step{Opcode::Log}, Step{Opcode::Scale, {-1.0 / 30}}}) {
      quotient.push_back(step);
    }
    return vm::evaluate_slope(formula(quotient), dvec3(-0.25), dvec3(0.25), workspace);
  };
  const vm::SlopeBound both_sides = bound({{Opcode::Abs}});
  CHECK(both_sides.lipschitz < 20);
  CHECK(both_sides.float_error < 1e-4);
  CHECK(bound({{Opcode::Abs}, {Opcode::Y}, {Opcode::Max}}).lipschitz < 20);
  CHECK(bound({{Opcode::Abs}, {Opcode::Scale, {2}}, {Opcode::Y}, {Opcode::Max}}).lipschitz < 20);
  CHECK(!std::isfinite(bound({}).lipschitz));
  CHECK(!std::isfinite(bound({{Opcode::Y}, {Opcode::Max}}).lipschitz));
  CHECK(!std::isfinite(bound({{Opcode::Abs}, {Opcode::Negate}}).lipschitz));
}

TEST_CASE("a smooth union by exponentials is no steeper than its operands", "[interpret][formula][slope]") {
  vm::Workspace workspace;
  for (const double k : {0.1, 11.0, 30.0, 300.0}) {
    // -ln(exp(-k x) + exp(-k y)) / k. Without bounds of the logarithm, the sum may be 0 and the slope has no bound.
    const auto program = formula({{Opcode::X},
                                  {Opcode::Scale, {-k}},
                                  {Opcode::Exp},
                                  {Opcode::Y},
                                  {Opcode::Scale, {-k}},
                                  {Opcode::Exp},
                                  {Opcode::Add},
                                  {Opcode::Log},
                                  {Opcode::Scale, {-1 / k}}});
    INFO("k = " << k);
    CHECK(vm::evaluate_slope(program, dvec3(-2), dvec3(2), workspace).lipschitz <= 1 + 1e-9);
    CHECK(vm::evaluate_slope(program, dvec3(0), dvec3(80 / k), workspace).float_error <= 32 * 0x1p-24 * (80 / k));
    if (k <= 100) continue;
    // Both exponentials underflow in float.
    CHECK(!std::isfinite(evaluate_float(program, glm::vec3(2), workspace)));
    CHECK(!std::isfinite(vm::evaluate_slope(program, dvec3(1), dvec3(2), workspace).float_error));
  }
}

TEST_CASE("the length of the point has slope 1 everywhere", "[interpret][formula][slope]") {
  vm::Workspace workspace;
  const auto program = formula({{Opcode::X},
                                {Opcode::Square},
                                {Opcode::Y},
                                {Opcode::Square},
                                {Opcode::Add},
                                {Opcode::Z},
                                {Opcode::Square},
                                {Opcode::Add},
                                {Opcode::Sqrt},
                                {Opcode::Offset, {1}}});
  const vm::SlopeBound bound = vm::evaluate_slope(program, dvec3(-2), dvec3(2), workspace);
  CHECK(bound.lipschitz <= 1 + 1e-9);
  CHECK(bound.float_error <= 1e-2);  // at the origin the root turns 2^-24 into 2^-12
  const vm::SlopeBound away = vm::evaluate_slope(program, dvec3(0.5), dvec3(2), workspace);
  CHECK(away.float_error <= 64 * 0x1p-24);
}

TEST_CASE("an intersection at a right angle is no steeper than the operand that is above 0",
          "[interpret][formula][slope]") {
  vm::Workspace workspace;
  // 3 x, met by a half-space that is 100 times as steep: alone 3 x counts where x > 0 > y, and both where x, y > 0.
  const auto program =
      formula({{Opcode::X}, {Opcode::Scale, {3}}, {Opcode::Y}, {Opcode::Scale, {300}}, {Opcode::Meet}});
  CHECK(vm::evaluate_slope(program, dvec3(-0.5, -2, 0), dvec3(2, -1, 1), workspace).lipschitz <= 3 + 1e-9);
  CHECK(vm::evaluate_slope(program, dvec3(-1), dvec3(1), workspace).lipschitz <= std::hypot(3, 300) * (1 + 1e-9));
}

TEST_CASE("a blend of what is not below 0 may be", "[interpret][formula][slope]") {
  vm::Workspace workspace;
  const double k = 0.5;
  // At x = y = 0 the blend of |x| and |y| is -k / 4, below the constant in the min that follows.
  const auto program = formula({{Opcode::X},
                                {Opcode::Abs},
                                {Opcode::Y},
                                {Opcode::Abs},
                                {Opcode::SmoothMin, {k, 1 / (4 * k)}},
                                {Opcode::Constant, {-0.015625}},
                                {Opcode::Min}});
  REQUIRE(vm::evaluate_distance(program, dvec3(0), workspace) == -k / 4);
  const vm::SlopeBound bound = vm::evaluate_slope(program, dvec3(-1e-3), dvec3(1e-3), workspace);
  CHECK(bound.value.lo <= -k / 4);
  CHECK(bound.lipschitz >= 1);
}

}  // namespace fathom::test::formula_test
