// Parts of programs, specialised for a box and for limits of the value. In the box a part has the whole program's
// bits wherever the value is within the limits. If the whole program is beyond a limit, the part is beyond that
// limit, too.
#include "vm/prune/specialise.h"

#include <bit>
#include <cmath>
#include <limits>
#include <set>
#include <variant>

#include "compiler/lower/fuse.h"
#include "tests/support/catch.h"
#include "tests/support/compiled.h"
#include "tests/support/plain_lowering.h"
#include "tests/support/random/random_program.h"
#include "tests/support/random/random_scene.h"
#include "tests/support/scaled_cases.h"
#include "tests/vm/interpret/formula.h"
#include "vm/range/slope.h"

namespace fathom::test::specialise_test {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr std::size_t kPoints = 24;  // per box

struct BoxSet {
  float lo[3][vm::kEnclosedBoxes], hi[3][vm::kEnclosedBoxes];
  vm::Boxes view() const { return {{lo[0], lo[1], lo[2]}, {hi[0], hi[1], hi[2]}}; }
};

BoxSet random_box_set(Random& random) {
  static const double kSizes[] = {1e-3, 0.03, 0.1, 0.3, 1, 3};
  BoxSet boxes;
  for (std::size_t i = 0; i < vm::kEnclosedBoxes; ++i) {
    const double size = kSizes[random.below(6)];
    for (int axis = 0; axis < 3; ++axis) {
      boxes.lo[axis][i] = static_cast<float>(random.uniform(-2.5, 2.5));
      boxes.hi[axis][i] = boxes.lo[axis][i] + static_cast<float>(size * random.uniform(0.2, 1));
    }
  }
  return boxes;
}

struct PointSet {
  std::vector<float> x, y, z;
  vm::Points view() const { return {x.data(), y.data(), z.data()}; }
};

PointSet points_in(const BoxSet& boxes, std::size_t box, Random& random) {
  PointSet points;
  for (std::size_t i = 0; i < kPoints; ++i) {
    float p[3];
    for (int axis = 0; axis < 3; ++axis) {
      const float lo = boxes.lo[axis][box], hi = boxes.hi[axis][box];
      const float within = static_cast<float>(random.uniform(static_cast<double>(lo), static_cast<double>(hi)));
      p[axis] = random.chance(0.2) ? (random.chance(0.5) ? lo : hi) : std::min(hi, std::max(lo, within));
    }
    points.x.push_back(p[0]), points.y.push_back(p[1]), points.z.push_back(p[2]);
  }
  return points;
}

// The part's words as a program, for the verifier.
vm::Program as_program(const vm::PrunedProgram& part) {
  vm::Program program;
  program.words = part.words, program.doubles = part.doubles, program.locals = part.locals;
  return program;
}

bool sound(const vm::PrunedProgram& part) {
  const auto verified = vm::verify(as_program(part));
  const auto* program = std::get_if<vm::VerifiedProgram>(&verified);
  if (program == nullptr) {
    UNSCOPED_INFO(std::get<vm::VerifyError>(verified).reason);
    return false;
  }
  return program->max_values() == part.max_values && program->max_points() == part.max_points &&
         program->choices() == part.choices && program->cost() == part.cost;
}

struct Tally {
  std::size_t compared = 0, wrong = 0, cut = 0;
};

// True if a part's value may replace the whole program's: equal (ignoring the sign of zero), or beyond the same
// limit.
bool agrees(float whole, float part, float least, float most) {
  if (whole < least) return part < least;
  if (whole > most) return part > most;
  return part == whole || (std::isnan(part) && std::isnan(whole));
}

void compare(const vm::Code& whole, const vm::PrunedProgram& part, const BoxSet& boxes, std::size_t box, float least,
             float most, Random& random, Tally& tally) {
  const PointSet points = points_in(boxes, box, random);
  std::vector<float> a(kPoints), b(kPoints);
  vm::Workspace workspace;
  vm::evaluate_distance(whole, points.view(), kPoints, a.data(), workspace);
  vm::evaluate_distance(part, points.view(), kPoints, b.data(), workspace);
  for (std::size_t i = 0; i < kPoints; ++i) {
    ++tally.compared;
    tally.wrong += !agrees(a[i], b[i], least, most);
  }
}

// Specialises a program for random boxes and limits, and each part again for a smaller box.
void cut(const vm::Code& whole, Random& random, Tally& tally) {
  const vm::PrunedProgram first = vm::whole(whole);
  vm::Workspace workspace;
  vm::Specialiser specialiser, again;
  const BoxSet boxes = random_box_set(random);
  REQUIRE(specialiser.enclose_choices(first, boxes.view(), workspace));
  static const float kLimits[][2] = {
      {-kInfinity, kInfinity}, {-kInfinity, 0.25f}, {0, 0}, {-0.1f, 0.1f}, {-kInfinity, 1e-3f}};
  for (const auto& [least, most] : kLimits) {
    specialiser.resolve(least, most);
    for (std::size_t box = 0; box < vm::kEnclosedBoxes; box += 3) {
      vm::PrunedProgram part, smaller;
      specialiser.prune(box, part);
      REQUIRE(sound(part));
      tally.cut += part.words.size() < first.words.size();
      compare(whole, part, boxes, box, least, most, random, tally);
      BoxSet within = boxes;
      for (int axis = 0; axis < 3; ++axis) {
        for (std::size_t i = 0; i < vm::kEnclosedBoxes; ++i) {
          within.lo[axis][i] = boxes.lo[axis][box];
          within.hi[axis][i] = boxes.lo[axis][box] + (boxes.hi[axis][box] - boxes.lo[axis][box]) / 2;
        }
      }
      REQUIRE(again.enclose_choices(part, within.view(), workspace));
      again.resolve(least, most);
      again.prune(0, smaller);
      REQUIRE(sound(smaller));
      compare(whole, smaller, within, 0, least, most, random, tally);
    }
  }
}

// Formulas joined by choice instructions, so that there is something to prune.
std::vector<Step> random_choices(Random& random, int count) {
  using vm::Opcode;
  std::vector<Step> steps;
  for (int i = 0; i < count; ++i) {
    append_random_formula(random, random.below(5), steps);
    steps.push_back({Opcode::Offset, {random.uniform(-1, 1)}});
    if (i == 0) continue;
    const double k = random.length(1e-3, 1);
    static const Opcode kPlain[] = {Opcode::Min, Opcode::Max, Opcode::Subtract};
    static const Opcode kBlends[] = {Opcode::SmoothMin, Opcode::SmoothMax, Opcode::SmoothSubtract};
    if (random.chance(0.3)) {
      steps.push_back({kBlends[random.below(3)], {k, 1 / (4 * k)}});
    } else {
      steps.push_back({kPlain[random.below(3)]});
    }
  }
  return steps;
}

void random_box(Random& random, glm::dvec3& lo, glm::dvec3& hi) {
  const double size = random.length(1e-3, 3);
  for (int axis = 0; axis < 3; ++axis) {
    lo[axis] = random.uniform(-2.5, 2.5);
    hi[axis] = lo[axis] + size * random.uniform(0.2, 1);
  }
}

glm::vec3 float_point_in(Random& random, glm::dvec3 lo, glm::dvec3 hi) {
  glm::vec3 p;
  for (int axis = 0; axis < 3; ++axis) {
    p[axis] = static_cast<float>(random.uniform(lo[axis], hi[axis]));
    const bool inside = static_cast<double>(p[axis]) >= lo[axis] && static_cast<double>(p[axis]) <= hi[axis];
    if (!inside) p[axis] = static_cast<float>((lo[axis] + hi[axis]) / 2);
  }
  return p;
}

// Random number from a set in which some are close to each other and some are infinite.
float random_end(Random& random) {
  static const float kEnds[] = {-kInfinity, -1, -0.5f, 0, 0.25f, 0.5f, 1, kInfinity};
  return kEnds[random.below(8)] + static_cast<float>(random.below(3)) * 0x1p-24f;
}
void random_range(Random& random, float& lo, float& hi) {
  lo = random_end(random), hi = random_end(random);
  if (lo > hi) std::swap(lo, hi);
}

}  // namespace

TEST_CASE("specialise: parts of random scenes give the whole programs' bits in their boxes", "[prune][specialise]") {
  Tally tally;
  for (int seed = 0; seed < scaled_cases(200); ++seed) {
    Random random(seed);
    const vm::VerifiedProgram plain = plain_lowering(random_scene(random));
    auto fused = vm::verify(compiler::fuse(plain.program()));
    INFO("seed " << seed);
    const std::size_t before = tally.wrong;
    cut(plain, random, tally);
    CHECK(tally.wrong == before);
    cut(std::get<vm::VerifiedProgram>(fused), random, tally);
    CHECK(tally.wrong == before);
  }
  CHECK(tally.compared > static_cast<std::size_t>(scaled_cases(250'000)));
  CHECK(tally.cut > static_cast<std::size_t>(scaled_cases(5'000)));
}

TEST_CASE("specialise: parts by bounds of the exact function equal it, in double and in float",
          "[prune][specialise][slope]") {
  vm::Workspace workspace;
  vm::Specialiser specialiser;
  int cut = 0, compared = 0;
  for (std::uint64_t seed = 0; seed < 3000; ++seed) {
    Random random(seed);
    const auto steps = random_choices(random, 2 + random.below(6));
    const vm::VerifiedProgram program = formula(steps);
    const auto subexpressions_of = subexpressions(steps);
    const vm::PrunedProgram whole = vm::whole(program);
    glm::dvec3 lo, hi;
    random_box(random, lo, hi);
    const vm::SlopeBound bound = specialiser.enclose_choices(whole, lo, hi, workspace);
    specialiser.resolve(-kInfinity, kInfinity);
    vm::PrunedProgram part;
    specialiser.prune(0, part);
    INFO("seed " << seed << ": " << text_of(steps));
    REQUIRE(sound(part));
    cut += part.words.size() < whole.words.size();
    // The part's bounds are valid for the whole program and at least as tight.
    const vm::SlopeBound same = vm::evaluate_slope(program, lo, hi, workspace);
    CHECK((bound.lipschitz == same.lipschitz && bound.float_error == same.float_error));
    const vm::SlopeBound again = vm::evaluate_slope(part, lo, hi, workspace);
    CHECK(again.lipschitz <= bound.lipschitz);
    CHECK(again.float_error <= bound.float_error);
    for (int i = 0; i < 8; ++i) {
      const glm::vec3 p = float_point_in(random, lo, hi);
      if (!defined_at(subexpressions_of, glm::dvec3(p), workspace)) continue;
      ++compared;
      const double exact = vm::evaluate_distance(program, glm::dvec3(p), workspace);
      CHECK(vm::evaluate_distance(part, glm::dvec3(p), workspace) == exact);
      CHECK((exact >= again.value.lo && exact <= again.value.hi));
      const vm::Points point = {&p.x, &p.y, &p.z};
      float a, b;
      vm::evaluate_distance(program, point, 1, &a, workspace);
      vm::evaluate_distance(part, point, 1, &b, workspace);
      CHECK(agrees(a, b, -kInfinity, kInfinity));
      if (std::isfinite(again.float_error)) CHECK(std::abs(static_cast<double>(a) - exact) <= again.float_error);
    }
  }
  CHECK(cut > 1000);
  CHECK(compared > 8000);
}

// Two planes whose gap is about the blend's width, which double and float round to different sides of the width. The
// specialiser must keep the operands that the exact blend still mixes.
TEST_CASE("specialise: operands that only float holds apart are kept for the exact function",
          "[prune][specialise][slope]") {
  vm::Workspace workspace;
  const double k = 0.1 + 1e-9;  // float rounds it down to 0.1f
  const double apart = static_cast<double>(static_cast<float>(k));
  REQUIRE(apart < k * (1 + 1e-7));
  for (const double gap : {apart, k, k * (1 + 1e-8), k * (1 + 1e-3)}) {
    const auto program = formula(
        {{vm::Opcode::X}, {vm::Opcode::X}, {vm::Opcode::Offset, {-gap}}, {vm::Opcode::SmoothMin, {k, 1 / (4 * k)}}});
    vm::Specialiser specialiser;
    const vm::PrunedProgram whole = vm::whole(program);
    specialiser.enclose_choices(whole, glm::dvec3(0), glm::dvec3(0), workspace);
    specialiser.resolve(-kInfinity, kInfinity);
    CHECK((specialiser.choices_left(0) == 0) == (gap > k * (1 + 1e-6)));
  }
}

// min(sqrt(x), y): where x is negative the value is y, which is beyond the limit. Regression: the specialiser kept
// only the root, so the value beyond the limit became NaN.
TEST_CASE("specialise: what may be NaN is not left alone for a limit's sake", "[prune][specialise]") {
  using vm::Opcode;
  const std::vector<std::vector<Step>> programs = {
      {{Opcode::X}, {Opcode::Sqrt}, {Opcode::Y}, {Opcode::Min}},
      {{Opcode::X}, {Opcode::Sqrt}, {Opcode::Y}, {Opcode::Negate}, {Opcode::Max}, {Opcode::Negate}},
      {{Opcode::X}, {Opcode::Sqrt}, {Opcode::Y}, {Opcode::Subtract}, {Opcode::Negate}}};
  vm::Workspace workspace;
  for (const std::vector<Step>& steps : programs) {
    const vm::VerifiedProgram program = formula(steps);
    const vm::PrunedProgram whole = vm::whole(program);
    BoxSet boxes;
    for (std::size_t i = 0; i < vm::kEnclosedBoxes; ++i) {
      for (int axis = 0; axis < 3; ++axis) boxes.lo[axis][i] = 1, boxes.hi[axis][i] = 2;
      boxes.lo[0][i] = -1;
    }
    vm::Specialiser specialiser;
    REQUIRE(specialiser.enclose_choices(whole, boxes.view(), workspace));
    for (const float most : {0.f, 0.25f}) {
      specialiser.resolve(-kInfinity, most);
      vm::PrunedProgram part;
      specialiser.prune(0, part);
      INFO(text_of(steps) << " up to " << most);
      for (const float x : {-1.f, -1e-30f}) {
        const glm::vec3 p(x, 1.5f, 1);
        float value;
        vm::evaluate_distance(part, {&p.x, &p.y, &p.z}, 1, &value, workspace);
        CHECK(evaluate_float(program, p, workspace) == 1.5f);
        CHECK(value > most);
      }
    }
  }
}

TEST_CASE("specialise: choices settled by pairs are those settled where each is of interest everywhere",
          "[prune][specialise]") {
  Random random(11);
  std::vector<vm::ChoiceLink> links;
  std::vector<vm::ChoiceRange> ranges;
  std::vector<vm::ChoiceBounds> bounds;
  for (int i = 0; i < 20'000; ++i) {
    const auto rule = static_cast<vm::ChoiceRule>(random.below(3));
    const float width = random.chance(0.5) ? 0 : 0.25f;
    links.push_back({rule, random.chance(0.5), true, width, {vm::kNone, 0}, {vm::kNone, 0}});
    vm::ChoiceRange& range = ranges.emplace_back();
    random_range(random, range.a_lo, range.a_hi), random_range(random, range.b_lo, range.b_hi);
    vm::ChoiceBounds& same = bounds.emplace_back();
    same.a_lo[0] = range.a_lo, same.a_hi[0] = range.a_hi, same.b_lo[0] = range.b_lo, same.b_hi[0] = range.b_hi;
  }
  std::vector<vm::DemandedRange> demanded(links.size());
  std::vector<vm::LiveOperands> pairs(links.size()), all(links.size());
  vm::resolve_pairs(links.data(), ranges.data(), links.size(), pairs.data());
  vm::resolve_choices(links.data(), bounds.data(), links.size(), {vm::kNone, 0}, -kInfinity, kInfinity, 0,
                      demanded.data(), all.data());
  int cut = 0, wrong = 0;
  for (std::size_t i = 0; i < links.size(); ++i) {
    wrong += pairs[i].a != (all[i].a & 1) || pairs[i].b != (all[i].b & 1);
    cut += pairs[i].a != pairs[i].b;
  }
  CHECK(wrong == 0);
  CHECK(cut > 3000);
}

// Regression: a drop with no value on the stack wrote before the beginning of the reader's own stack.
TEST_CASE("a program that drops a point at which nothing was computed is no expression", "[prune][specialise]") {
  vm::Program program;
  program.append(vm::Opcode::Translate, 0, {1, 0, 0}, {});
  program.append(vm::Opcode::Drop, 0, {}, {});
  program.append(vm::Opcode::Sphere, 0, {1}, {});
  const auto verified = vm::verify(program);
  REQUIRE(std::holds_alternative<vm::VerifiedProgram>(verified));
  vm::DefUseGraph expression;
  CHECK_FALSE(expression.read(std::get<vm::VerifiedProgram>(verified)));
}

TEST_CASE("any sound program can be read as an expression or is refused", "[prune][specialise]") {
  vm::DefUseGraph expression;
  int expressions = 0;
  for (int seed = 0; seed < scaled_cases(4000); ++seed) {
    Random random(static_cast<std::uint64_t>(seed));
    const vm::VerifiedProgram program = random_program(random, 1 + seed % 30);
    if (!expression.read(program)) continue;
    ++expressions;
    REQUIRE(expression.nodes().size() == program.instructions());
    for (const vm::DefUseNode& node : expression.nodes()) {
      for (const std::uint32_t operand : {node.a, node.b, node.point}) {
        REQUIRE((operand == vm::kNone || operand <= expression.root()));
      }
    }
  }
  CHECK(expressions > 10);
}

// Regression: the reader compared each moved shape of a program with locals with all earlier ones, which took
// minutes.
TEST_CASE("places that are met again are found among a hundred thousand", "[prune][specialise]") {
  vm::Program program;
  program.locals = 1;
  program.append(vm::Opcode::Sphere, 0, {1}, {});
  program.append(vm::Opcode::Tee, 0, {}, {});
  const int places = 100000;
  for (int i = 0; i < 2 * places; ++i) {
    program.append(vm::Opcode::Revolve, 0, {static_cast<double>(i % places)}, {});
    program.append(vm::Opcode::Sphere, 0, {1}, {});
    program.append(vm::Opcode::Drop, 0, {}, {});
    program.append(vm::Opcode::Min, 0, {}, {});
  }
  const auto verified = vm::verify(program);
  REQUIRE(std::holds_alternative<vm::VerifiedProgram>(verified));
  vm::DefUseGraph expression;
  CHECK(expression.read(std::get<vm::VerifiedProgram>(verified)));
}

}  // namespace fathom::test::specialise_test
