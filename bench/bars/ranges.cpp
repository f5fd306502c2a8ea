// B16: interval bounds of random scenes contain the sampled values.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>
#include <iterator>
#include <utility>

#include "bench/bars/bars.h"
#include "tests/support/plain_lowering.h"
#include "tests/support/random/random_scene.h"
#include "vm/interpret/evaluate.h"
#include "vm/range/slope.h"

namespace fathom::bench {
namespace {

using glm::dvec3;

// Sides of boxes and lengths of segments, scene units.
constexpr double kSides[] = {0, 1e-9, 1e-6, 1e-3, 0.05, 0.3, 1, 4};
constexpr int kBoxes = 24, kSamples = 64;  // boxes per scene, samples per box
// Bound of the relative rounding error of values in double, whose differences are taken.
constexpr double kRounding = 1e-12;

struct Tally {
  std::size_t tried = 0, outside = 0;
  // An unbounded range excludes nothing and is not counted.
  void inside(double value, vm::Range range) {
    if (!std::isfinite(range.lo) && !std::isfinite(range.hi)) return;
    ++tried, outside += !(value >= range.lo && value <= range.hi);
  }
  void at_most(double value, double limit) {
    if (std::isfinite(limit)) ++tried, outside += !(value <= limit);
  }
};

// Tries boxes and segments of one program.
class Trial {
 public:
  Trial(const vm::VerifiedProgram& program, test::Random& random, vm::Workspace& workspace)
      : program_(program), random_(random), workspace_(workspace) {}

  void range(Tally& values) {
    const auto [lo, hi] = box();
    const vm::Range range = vm::evaluate_range(program_, lo, hi, workspace_);
    for (int i = 0; i < kSamples; ++i) values.inside(value(point(lo, hi)), range);
  }

  void along(Tally& values, Tally& derivatives) {
    const dvec3 origin = random_.in_box(3), direction = random_.direction() * random_.length(0.25, 4);
    const double begin = random_.uniform(-3, 3), end = begin + side();
    const vm::AlongLine line = vm::evaluate_along(program_, origin, direction, begin, end, workspace_);
    double last_t = begin, last = value(origin + begin * direction);
    for (int i = 0; i < kSamples; ++i) {
      const double t = place(begin, end), f = value(origin + t * direction);
      values.inside(f, line.value);
      const double dt = t - last_t, slack = kRounding * scale(origin + t * direction, f) / std::abs(dt);
      if (dt != 0) derivatives.inside((f - last) / dt, {line.derivative.lo - slack, line.derivative.hi + slack});
      last_t = t, last = f;
    }
  }

  void slope(Tally& values, Tally& changes, Tally& errors) {
    const auto [lo, hi] = box();
    const vm::SlopeBound bound = vm::evaluate_slope(program_, lo, hi, workspace_);
    dvec3 last_p = lo;
    double last = value(lo);
    for (int i = 0; i < kSamples; ++i) {
      const dvec3 p = point(lo, hi);
      const double f = value(p), slack = kRounding * scale(p, f);
      values.inside(f, bound.value);
      if (p != last_p) changes.at_most(std::abs(f - last), bound.lipschitz * glm::length(p - last_p) + slack);
      const dvec3 q(glm::vec3(p.x, p.y, p.z));
      if (glm::all(glm::greaterThanEqual(q, lo)) && glm::all(glm::lessThanEqual(q, hi)))
        errors.at_most(std::abs(value_in_float(q) - value(q)), bound.float_error);
      last_p = p, last = f;
    }
  }

 private:
  double value(dvec3 p) { return vm::evaluate_distance(program_, p, workspace_); }
  double value_in_float(dvec3 p) {
    const glm::vec3 at(p);
    float f;
    vm::evaluate_distance(program_, {&at.x, &at.y, &at.z}, 1, &f, workspace_);
    return static_cast<double>(f);
  }
  static double scale(dvec3 p, double f) { return std::max({1.0, glm::length(p), std::abs(f)}); }

  double side() { return kSides[random_.below(static_cast<int>(std::size(kSides)))]; }
  std::pair<dvec3, dvec3> box() {
    const dvec3 lo = random_.in_box(2), sides(side(), side(), side());
    return {lo, lo + sides};
  }
  // Returns a random number in [lo, hi], the ends themselves in one of five cases.
  double place(double lo, double hi) {
    const double share = random_.chance(0.2) ? random_.below(2) : random_.uniform(0, 1);
    return std::clamp(lo + share * (hi - lo), lo, hi);
  }
  dvec3 point(dvec3 lo, dvec3 hi) {
    const double x = place(lo.x, hi.x), y = place(lo.y, hi.y);
    return {x, y, place(lo.z, hi.z)};
  }

  const vm::VerifiedProgram& program_;
  test::Random& random_;
  vm::Workspace& workspace_;
};

}  // namespace

void range_bars(BarTable& table, const Counts& counts) {
  Tally range, along, derivative, slope, change, error;
  vm::Workspace workspace;
  std::uint64_t seed = 0;
  for (; range.tried < counts.samples; ++seed) {
    test::Random random(seed);
    const vm::VerifiedProgram program = test::plain_lowering(test::random_scene(random));
    Trial trial(program, random, workspace);
    for (int i = 0; i < kBoxes; ++i) {
      trial.range(range);
      trial.along(along, derivative);
      trial.slope(slope, change, error);
    }
  }
  const auto print = [&](const char* what, const Tally& tally) {
    table.none("B16", fmt::format("{} random scenes, {}", seed, what), tally.outside, tally.tried);
  };
  print("ranges over boxes: values outside", range);
  print("ranges along lines: values outside", along);
  print("derivatives along lines: difference quotients outside", derivative);
  print("slopes over boxes: values outside", slope);
  print("slopes over boxes: changes above the constant", change);
  print("slopes over boxes: float errors above the bound", error);
}

}  // namespace fathom::bench
