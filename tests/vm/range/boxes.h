// Helpers for the tests of enclosures: boxes of all kinds, points in them, programs of all kinds.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "tests/support/catch.h"
#include "tests/vm/interpret/formula.h"
#include "tests/vm/number/float_bits.h"
#include "vm/range/enclose.h"

namespace fathom::test {

using vm::kEnclosedBoxes;

inline constexpr float kInf = std::numeric_limits<float>::infinity();
inline constexpr float kLargest = std::numeric_limits<float>::max();

struct BoxSet {
  float lo[3][kEnclosedBoxes], hi[3][kEnclosedBoxes];
  vm::Boxes view() const { return {{lo[0], lo[1], lo[2]}, {hi[0], hi[1], hi[2]}}; }
};

// Random boxes about where the shapes are: from points to a hundred units wide, some flat or unbounded.
inline BoxSet random_boxes(Random& random) {
  static const double kSizes[] = {0, 1e-6, 1e-3, 0.05, 0.3, 1, 4, 100};
  BoxSet boxes;
  for (std::size_t i = 0; i < kEnclosedBoxes; ++i) {
    const double size = kSizes[random.below(8)];
    for (int axis = 0; axis < 3; ++axis) {
      const double begin = random.uniform(-3, 3), width = random.chance(0.1) ? 0 : size * random.uniform(0, 1);
      boxes.lo[axis][i] = static_cast<float>(begin);
      boxes.hi[axis][i] = std::max(boxes.lo[axis][i], static_cast<float>(begin + width));
      if (random.chance(0.03)) boxes.lo[axis][i] = -kInf;
      if (random.chance(0.03)) boxes.hi[axis][i] = kInf;
    }
  }
  return boxes;
}

// Random float in [lo, hi]: an end, or any number between. If an end is infinite, the number may have any
// magnitude.
inline float random_within(Random& random, float lo, float hi) {
  const int pick = random.below(6);
  if (pick == 0) return std::max(lo, -kLargest);
  if (pick == 1) return std::min(hi, kLargest);
  const double from = std::max(lo, -kLargest), to = std::min(hi, kLargest);
  if (std::isinf(lo) || std::isinf(hi)) {
    const double near = std::isinf(lo) ? (std::isinf(hi) ? 0.0 : hi) : lo;
    const double far = std::exp(random.uniform(-3, pick == 2 ? 88 : 5)) * (random.chance(0.5) ? 1 : -1);
    return static_cast<float>(std::clamp(near + far, from, to));
  }
  return std::clamp(static_cast<float>(from + (to - from) * random.uniform(0, 1)), lo, hi);
}

inline bool holds(float lo, float hi, float value) {
  return lo <= hi && (std::isnan(value) ? lo == -kInf && hi == kInf : lo <= value && value <= hi);
}

// `count` points per box, box after box.
inline Cloud points_in(const BoxSet& boxes, Random& random, int count) {
  Cloud cloud;
  for (std::size_t i = 0; i < kEnclosedBoxes; ++i) {
    for (int n = 0; n < count; ++n) {
      float p[3];
      for (int axis = 0; axis < 3; ++axis) p[axis] = random_within(random, boxes.lo[axis][i], boxes.hi[axis][i]);
      cloud.add(p[0], p[1], p[2]);
    }
  }
  return cloud;
}

inline std::vector<float> distances(const vm::VerifiedProgram& program, const Cloud& cloud,
                                    vm::Workspace& workspace) {
  std::vector<float> d(cloud.size());
  vm::evaluate_distance(program, cloud.from(0), cloud.size(), d.data(), workspace);
  return d;
}

// Returns how many values at the points of points_in() lie outside [lo, hi] of their box. Reports the first.
inline int count_outside(const std::vector<float>& values, const Cloud& cloud, const float* lo, const float* hi,
                         const std::string& name) {
  int outside = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::size_t box = i / (values.size() / kEnclosedBoxes);
    if (holds(lo[box], hi[box], values[i])) continue;
    if (outside++ == 0) {
      FAIL_CHECK(name << ": " << values[i] << " not in [" << lo[box] << ", " << hi[box] << "] at " << cloud.x[i]
                      << " " << cloud.y[i] << " " << cloud.z[i]);
    }
  }
  return outside;
}

struct Enclosed {
  float lo[kEnclosedBoxes], hi[kEnclosedBoxes];
  std::vector<vm::ChoiceBounds> choices;
};
inline Enclosed enclosed(const vm::VerifiedProgram& program, const BoxSet& boxes, vm::Workspace& workspace) {
  Enclosed result;
  vm::enclose(program, boxes.view(), result.lo, result.hi, result.choices, workspace);
  REQUIRE(result.choices.size() == program.choices());
  return result;
}

struct BoxSample {
  vm::VerifiedProgram program;
  std::string name;
};

// Returns a primitive (every kind in turn), a graph or a formula.
inline BoxSample sample(std::uint64_t seed, Random& random) {
  const std::string number = "seed " + std::to_string(seed);
  if (seed % 3 == 0) {
    GraphOptions options;
    options.mandelbulbs = seed % 4 == 0;
    return {plain_lowering(random_scene(random, options)), number};
  }
  if (seed % 3 == 1) {
    const auto steps = random_formula(seed);
    return {formula(steps), number + ": " + text_of(steps)};
  }
  std::vector<compiler::Kind> kinds = primitive_kinds(compiler::Sort::Solid, true);
  const std::vector<compiler::Kind> outlines = primitive_kinds(compiler::Sort::Outline, true);
  kinds.insert(kinds.end(), outlines.begin(), outlines.end());
  const compiler::Kind kind = kinds[seed / 3 % kinds.size()];
  return {primitive_program(kind, random_params(kind, random)),
          number + ": " + std::string(compiler::spec(kind).name)};
}

}  // namespace fathom::test
