#include "tests/support/evaluator_bits.h"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <limits>
#include <span>
#include <sstream>
#include <string_view>
#include <utility>
#include <vector>

#include "compiler/compile.h"
#include "tests/support/random/random_program.h"
#include "tests/vm/number/float_bits.h"
#include "vm/encoding/digest.h"
#include "vm/interpret/trace.h"
#include "vm/program/check.h"
#include "vm/prune/program_template.h"
#include "vm/range/slope.h"

namespace fathom::test::evaluators {
namespace {

using glm::dvec3;

constexpr int kRandomPrograms = 300;
constexpr std::uint32_t kMaxCost = 5000;  // multiply-adds per point; the largest fractals would take all of the time
constexpr std::size_t kPoints = 37;       // not a multiple of any register's lanes
constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr const char* kScenes[] = {"blends",          "cornell",           "mandelbulb",      "primitives",
                                   "showcase",        "bench/b-csg",       "bench/e-gyroid",  "bench/f-formula",
                                   "bench/glass-box", "bench/h-composite", "chart/far-world", "chart/twist"};

// Bytes of results. All NaNs are one, since IEEE 754 leaves their sign and payload to the processor.
class Results {
 public:
  void add(float value) { append(bits_of(value)); }
  void add(double value) {
    append(std::bit_cast<std::uint64_t>(std::isnan(value) ? std::numeric_limits<double>::quiet_NaN() : value));
  }
  void add(std::uint32_t value) { append(value); }
  void add(dvec3 v) { add(v.x), add(v.y), add(v.z); }
  template <class T>
  void add_all(std::span<const T> values) {
    for (const T& value : values) add(value);
  }
  std::string digest() const { return vm::digest(bytes_).text(); }

 private:
  template <class Word>
  void append(Word word) {
    for (std::size_t i = 0; i < sizeof word; ++i) bytes_ += static_cast<char>(word >> (8 * i) & 0xff);
  }
  std::string bytes_;
};

// Points near the origin. Now and then a coordinate is an extreme or special float.
Cloud random_cloud(Random& random) {
  static const float kSpice[] = {0.f,
                                 -0.f,
                                 1e-45f,
                                 -1e-39f,
                                 1e-20f,
                                 1e19f,
                                 -1e30f,
                                 3.4e38f,
                                 kInfinity,
                                 -kInfinity,
                                 std::numeric_limits<float>::quiet_NaN()};
  Cloud cloud;
  for (std::size_t i = 0; i < kPoints; ++i) {
    float p[3];
    for (float& c : p) c = static_cast<float>(random.uniform(-2, 2));
    if (random.chance(0.15)) {
      const int axis = random.below(3);
      p[axis] = kSpice[random.below(11)];
    }
    cloud.add(p[0], p[1], p[2]);
  }
  return cloud;
}

struct BoxSet {
  alignas(64) float lo[3][vm::kEnclosedBoxes], hi[3][vm::kEnclosedBoxes];
  dvec3 least(std::size_t box) const { return {lo[0][box], lo[1][box], lo[2][box]}; }
  dvec3 most(std::size_t box) const { return {hi[0][box], hi[1][box], hi[2][box]}; }
  vm::Boxes view() const { return {{lo[0], lo[1], lo[2]}, {hi[0], hi[1], hi[2]}}; }
};

BoxSet random_boxes(Random& random) {
  static const double kSizes[] = {0, 1e-3, 0.03, 0.3, 1, 3};
  BoxSet boxes;
  for (std::size_t i = 0; i < vm::kEnclosedBoxes; ++i) {
    const double size = kSizes[random.below(6)];
    for (int axis = 0; axis < 3; ++axis) {
      boxes.lo[axis][i] = static_cast<float>(random.uniform(-2, 2));
      boxes.hi[axis][i] = boxes.lo[axis][i] + static_cast<float>(size * random.uniform(0.2, 1));
    }
  }
  return boxes;
}

// A program with the points and boxes at which it is evaluated.
struct Case {
  vm::VerifiedProgram program;
  Cloud cloud;
  BoxSet boxes;
};

dvec3 point_of(const Case& one, std::size_t i) { return {one.cloud.x[i], one.cloud.y[i], one.cloud.z[i]}; }

Case case_of(vm::VerifiedProgram program, std::uint64_t seed) {
  Random random(seed);
  Cloud cloud = random_cloud(random);
  return {std::move(program), std::move(cloud), random_boxes(random)};
}

std::vector<Case> all_cases() {
  std::vector<Case> cases;
  std::uint64_t seed = 0;
  while (cases.size() < kRandomPrograms) {
    Random random(++seed);
    const int instructions = 1 + random.below(40);
    vm::VerifiedProgram program = random_program(random, instructions);
    if (program.cost() <= kMaxCost) cases.push_back(case_of(std::move(program), ++seed));
  }
  for (const char* name : kScenes) {
    std::stringstream text;
    text << std::ifstream(fmt::format("{}/scenes/{}.json", FATHOM_SOURCE_DIR, name)).rdbuf();
    compiler::Diagnostics diagnostics;
    const auto scene = compiler::compile(compiler::Source(name, text.str()), diagnostics);
    CHECK(scene.has_value(), "a shipped scene compiles");
    cases.push_back(case_of(scene->distance, ++seed));
    cases.push_back(case_of(scene->surface, ++seed));
  }
  return cases;
}

void distances(const Case& one, vm::Workspace& workspace, Results& results) {
  float d[kPoints];
  vm::evaluate_distance(one.program, one.cloud.from(0), kPoints, d, workspace);
  results.add_all<float>(d);
}
void convexity(const Case& one, vm::Workspace& workspace, Results& results) {
  float d[kPoints], convex[kPoints];
  vm::evaluate_convex(one.program, one.cloud.from(0), kPoints, d, convex, workspace);
  results.add_all<float>(d), results.add_all<float>(convex);
}
void surfaces(const Case& one, vm::Workspace& workspace, Results& results) {
  float d[kPoints], x[kPoints], y[kPoints], z[kPoints], convex[kPoints];
  std::uint32_t surface[kPoints];
  vm::evaluate_surface(one.program, one.cloud.from(0), kPoints, {d, x, y, z, surface, convex}, workspace);
  for (const float* numbers : {d, x, y, z, convex}) results.add_all<float>({numbers, kPoints});
  results.add_all<std::uint32_t>(surface);
}
void doubles(const Case& one, vm::Workspace& workspace, Results& results) {
  double p[3][kPoints], d[kPoints];
  for (std::size_t i = 0; i < kPoints; ++i) {
    for (int axis = 0; axis < 3; ++axis) p[axis][i] = point_of(one, i)[axis];
    results.add(vm::evaluate_distance(one.program, point_of(one, i), workspace));
  }
  vm::evaluate_distance(one.program, vm::RealPoints{p[0], p[1], p[2]}, kPoints, d, workspace);
  results.add_all<double>(d);
}
void double_surfaces(const Case& one, vm::Workspace& workspace, Results& results) {
  for (std::size_t i = 0; i < kPoints; ++i) {
    const vm::SurfaceValue value = vm::evaluate_surface(one.program, point_of(one, i), workspace);
    results.add(value.distance), results.add(value.gradient), results.add(value.surface), results.add(value.convex);
    const vm::SurfacePlace place = vm::evaluate_place(one.program, point_of(one, i), workspace);
    results.add(place.surface), results.add(place.place);
  }
}
void shares(const Case& one, vm::Workspace& workspace, Results& results) {
  for (std::size_t i = 0; i < kPoints; ++i) {
    for (const auto evaluate : {vm::evaluate_shares, vm::evaluate_placed_shares}) {
      const vm::SurfaceShares found = evaluate(one.program, point_of(one, i), workspace);
      for (int n = 0; n < found.count; ++n) {
        const vm::SurfaceShare& share = found.all[static_cast<std::size_t>(n)];
        results.add(share.surface), results.add(share.weight), results.add(share.place);
      }
    }
  }
}
void ranges(const Case& one, vm::Workspace& workspace, Results& results) {
  for (std::size_t box = 0; box < vm::kEnclosedBoxes; ++box) {
    const vm::Range range = vm::evaluate_range(one.program, one.boxes.least(box), one.boxes.most(box), workspace);
    results.add(range.lo), results.add(range.hi);
  }
}
void lines(const Case& one, vm::Workspace& workspace, Results& results) {
  for (std::size_t box = 0; box < vm::kEnclosedBoxes; ++box) {
    const dvec3 from = one.boxes.least(box), way = one.boxes.most(box) - from;
    const vm::AlongLine along = vm::evaluate_along(one.program, from, way, 0.25, 0.5, workspace);
    for (const vm::Range& range : {along.value, along.derivative}) results.add(range.lo), results.add(range.hi);
  }
}
void enclosures(const Case& one, vm::Workspace& workspace, Results& results) {
  alignas(64) float lo[vm::kEnclosedBoxes], hi[vm::kEnclosedBoxes];
  std::vector<vm::ChoiceBounds> choices;
  vm::enclose(one.program, one.boxes.view(), lo, hi, choices, workspace);
  results.add_all<float>(lo), results.add_all<float>(hi);
  for (const vm::ChoiceBounds& choice : choices) {
    results.add_all<float>(choice.a_lo), results.add_all<float>(choice.a_hi);
    results.add_all<float>(choice.b_lo), results.add_all<float>(choice.b_hi);
  }
}
void slopes(const Case& one, vm::Workspace& workspace, Results& results) {
  std::vector<vm::ChoiceRange> choices;
  for (std::size_t box = 0; box < vm::kEnclosedBoxes; ++box) {
    const vm::SlopeBound bound =
        vm::enclose_slope(one.program, one.boxes.least(box), one.boxes.most(box), choices, workspace);
    for (const double number : {bound.value.lo, bound.value.hi, bound.lipschitz, bound.float_error})
      results.add(number);
    for (const vm::ChoiceRange& choice : choices) {
      for (const float number : {choice.a_lo, choice.a_hi, choice.b_lo, choice.b_hi}) results.add(number);
    }
  }
}
// Parts of the program in boxes, packed as templates, and their distances at the points.
void templates(const Case& one, vm::Workspace& workspace, Results& results) {
  const vm::Code code = one.program;
  const vm::PrunedProgram whole = vm::whole(code);
  vm::Specialiser specialiser;
  if (!specialiser.enclose_choices(whole, one.boxes.view(), workspace)) return;
  specialiser.resolve(-kInfinity, kInfinity);
  const vm::Constants constants(code);
  vm::ProgramTemplates packed;
  std::vector<std::uint32_t> pool;
  for (std::size_t box = 0; box < vm::kEnclosedBoxes; ++box) {
    vm::PrunedProgram part;
    specialiser.prune(box, part);
    results.add_all<std::uint32_t>(part.words);
    const std::uint32_t at = packed.pack(part, constants, pool);
    std::vector<vm::TemplateJob> jobs;
    for (std::uint32_t i = 0; i < kPoints; ++i)
      jobs.push_back({one.cloud.x[i], one.cloud.y[i], one.cloud.z[i], kInfinity, at, i});
    float d[kPoints];
    vm::evaluate_template(packed[pool[at]], constants, pool.data(), jobs, d, workspace);
    results.add_all<float>(d);
  }
}
void traces(const Case& one, vm::Workspace&, Results& results) {
  constexpr std::size_t kLongest = 500;  // words; the work grows with the square of a program's length
  if (one.program.program().words.size() > kLongest) return;
  vm::trace(one.program, point_of(one, 0), [&](const vm::TraceStep& step) {
    results.add_all<float>(step.values);
    for (const glm::vec3& point : step.points) results.add(point.x), results.add(point.y), results.add(point.z);
  });
}
void words(const Case& one, vm::Workspace&, Results& results) {
  results.add_all<std::uint32_t>(one.program.program().words);
}

struct Evaluator {
  const char* name;
  void (*run)(const Case&, vm::Workspace&, Results&);
};
constexpr Evaluator kEvaluators[] = {
    {"programs", words},       {"distance", distances}, {"convex", convexity},
    {"surface", surfaces},     {"double", doubles},     {"double-surface", double_surfaces},
    {"shares", shares},        {"range", ranges},       {"along", lines},
    {"enclosure", enclosures}, {"slope", slopes},       {"template", templates},
    {"trace", traces}};

std::string digest_of(const Evaluator& evaluator, const std::vector<Case>& cases) {
  vm::Workspace workspace;
  Results results;
  for (const Case& one : cases) evaluator.run(one, workspace, results);
  return results.digest();
}

}  // namespace
}  // namespace fathom::test::evaluators

namespace fathom::test {

std::string evaluator_bits() {
  using namespace evaluators;
  const IsaGuard guard;
  const std::vector<Case> cases = all_cases();
  std::string text = fmt::format("{} programs\n", cases.size());
  for (const Evaluator& evaluator : kEvaluators) {
    std::string best;
    for (const std::string_view isa : vm::available_isas()) {
      vm::force_isa(isa);
      const std::string digest = digest_of(evaluator, cases);
      if (best.empty()) text += fmt::format("{} {}\n", evaluator.name, best = digest);
      if (best != digest) text += fmt::format("{} {} on {}\n", evaluator.name, digest, isa);
    }
  }
  return text;
}

}  // namespace fathom::test
