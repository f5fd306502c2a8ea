// Value and derivative along a line: sampled values and slopes lie within the bounds for every opcode. The bounds are
// close to the exact answer, if that is known.
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "compiler/shapes/make_node.h"
#include "tests/support/catch.h"
#include "tests/support/judge/judge.h"
#include "tests/support/scaled_cases.h"
#include "tests/vm/interpret/formula.h"

namespace fathom::test::along_test {
namespace {

using compiler::Kind;
using glm::dvec3;
using vm::Opcode;

constexpr double kInf = std::numeric_limits<double>::infinity();

struct Stretch {
  dvec3 origin, direction;
  double begin, end;
  dvec3 at(double t) const { return origin + t * direction; }
};

// Random segment of a line through the scene, sometimes along an axis; length from zero to several units.
Stretch random_stretch(Random& random) {
  static const double kLengths[] = {0, 1e-6, 1e-3, 0.05, 0.3, 1, 4};
  dvec3 direction = random.direction() * random.length(0.25, 4);
  if (random.chance(0.2)) direction = dvec3(0), direction[random.below(3)] = random.chance(0.5) ? 1 : -1;
  const double begin = random.uniform(-2, 2);
  return {random.in_box(2), direction, begin, begin + kLengths[random.below(7)]};
}

vm::AlongLine along(const vm::VerifiedProgram& program, const Stretch& s, vm::Workspace& workspace) {
  return vm::evaluate_along(program, s.origin, s.direction, s.begin, s.end, workspace);
}

bool finite(vm::Range range) { return std::isfinite(range.lo) && std::isfinite(range.hi); }

std::string print(vm::Range range) { return std::to_string(range.lo) + " .. " + std::to_string(range.hi); }

// Checks that samples of the segment, and the slopes between them, lie within `line`. Samples at which `defined` is
// false are skipped. Returns the number of slopes compared with finite bounds.
template <class Value, class Defined>
int check_samples(const vm::AlongLine& line, const Stretch& s, Random& random, int samples, const Value& value,
                  const Defined& defined) {
  REQUIRE(line.value.lo <= line.value.hi);
  REQUIRE(line.derivative.lo <= line.derivative.hi);
  int compared = 0;
  double last_t = 0, last = std::nan("");
  for (int i = 0; i < samples; ++i) {
    const double share = i < 2 ? i : random.uniform(0, 1);
    const double t = std::clamp(s.begin + share * (s.end - s.begin), s.begin, s.end), f = value(t);
    if (!defined(t)) continue;
    if (!(f >= line.value.lo && f <= line.value.hi)) FAIL_CHECK(f << " not in " << print(line.value) << " at " << t);
    const double dt = std::abs(t - last_t), slope = (f - last) / (t - last_t);
    // Each value is off by a few roundings.
    const double slack = 1e-12 * std::max({1.0, std::abs(f), glm::length(s.at(t))}) / dt;
    if (dt > 0 && std::isfinite(last)) {
      compared += finite(line.derivative);
      if (!(slope >= line.derivative.lo - slack && slope <= line.derivative.hi + slack))
        FAIL_CHECK("slope " << slope << " not in " << print(line.derivative) << " between " << last_t << " and "
                            << t);
    }
    last_t = t, last = f;
  }
  return compared;
}

void add_opcodes(const vm::VerifiedProgram& program, std::set<Opcode>& seen) {
  const auto& words = program.program().words;
  for (std::size_t i = 0; i < words.size(); i += vm::instruction_length(words[i]))
    seen.insert(static_cast<Opcode>(words[i] & 0xff));
}

struct Sample {
  vm::VerifiedProgram program;
  std::vector<vm::VerifiedProgram> parts;  // subexpressions: the program is defined where all of them are finite
  std::string name;
};

// Returns a primitive (every kind in turn), a graph or a formula.
Sample sample(std::uint64_t seed, Random& random) {
  const std::string number = "seed " + std::to_string(seed);
  if (seed % 3 == 0) return {plain_lowering(random_scene(random)), {}, number};
  if (seed % 3 == 1) {
    const auto steps = random_formula(seed);
    return {formula(steps), subexpressions(steps), number + ": " + text_of(steps)};
  }
  std::vector<Kind> kinds = primitive_kinds(compiler::Sort::Solid, true);
  const std::vector<Kind> outlines = primitive_kinds(compiler::Sort::Outline, true);
  kinds.insert(kinds.end(), outlines.begin(), outlines.end());
  const Kind kind = kinds[seed / 3 % kinds.size()];
  return {primitive_program(kind, random_params(kind, random)),
          {},
          number + ": " + std::string(compiler::spec(kind).name)};
}

// Returns the program of a `kind` node over these children.
vm::VerifiedProgram over(Kind kind, const std::vector<double>& params,
                         const std::vector<std::pair<Kind, std::vector<double>>>& children) {
  compiler::Scene scene;
  compiler::NodeMaker maker(scene.graph);
  std::vector<compiler::NodeId> ids;
  for (const auto& [child, numbers] : children) ids.push_back(maker.make(child, numbers, {}));
  scene.root = maker.make(kind, params, ids);
  return plain_lowering(scene);
}

}  // namespace

TEST_CASE("along a line: values and slopes are within the bounds, of every opcode", "[number][along][heavy]") {
  vm::Workspace workspace;
  std::set<Opcode> seen;
  int stretches = 0, bounded = 0, compared = 0;
  for (std::uint64_t seed = 0; seed < 9000; ++seed) {
    Random random(seed);
    const Sample sampled = sample(seed, random);
    add_opcodes(sampled.program, seen);
    for (int i = 0; i < 6; ++i) {
      const Stretch s = random_stretch(random);
      INFO(sampled.name << ", stretch " << i);
      const vm::AlongLine line = along(sampled.program, s, workspace);
      ++stretches;
      bounded += finite(line.derivative);
      compared += check_samples(
          line, s, random, 12, [&](double t) { return vm::evaluate_distance(sampled.program, s.at(t), workspace); },
          [&](double t) { return defined_at(sampled.parts, s.at(t), workspace); });
    }
  }
  for (int i = 0; i < vm::kOpcodeCount; ++i) {
    const vm::OpcodeInfo& info = *vm::find_opcode(static_cast<std::uint32_t>(i));
    INFO(info.mnemonic);
    CHECK((info.form == vm::Form::Machine || seen.count(static_cast<Opcode>(i)) == 1));
  }
  INFO(bounded << " of " << stretches << " derivatives are bounded, " << compared << " slopes compared");
  CHECK(bounded > 0.8 * stretches);
  CHECK(compared > 8 * bounded);
}

TEST_CASE("along a line: sums of exponentials have bounded slopes", "[number][along]") {
  vm::Workspace workspace;
  int compared = 0;
  for (int seed = 0; seed < scaled_cases(2000); ++seed) {
    Random random(seed);
    std::vector<Step> steps;
    append_exponentials(random, 1 + random.below(4), steps);
    const vm::VerifiedProgram program = formula(steps);
    const auto parts = subexpressions(steps);
    const Stretch s = random_stretch(random);
    INFO("seed " << seed << ": " << text_of(steps));
    const vm::AlongLine line = along(program, s, workspace);
    compared += check_samples(
        line, s, random, 12, [&](double t) { return vm::evaluate_distance(program, s.at(t), workspace); },
        [&](double t) { return defined_at(parts, s.at(t), workspace); });
  }
  CHECK(compared > scaled_cases(2000) * 6);
}

TEST_CASE("along a line: values are the judge's", "[number][along]") {
  vm::Workspace workspace;
  for (int seed = 1; seed < scaled_cases(600); seed += 2) {
    Random random(seed);
    const compiler::Scene scene = random_scene(random);
    const vm::VerifiedProgram program = plain_lowering(scene);
    const Stretch s = random_stretch(random);
    const vm::AlongLine line = along(program, s, workspace);
    for (int i = 0; i < 8; ++i) {
      const double t = random.uniform(s.begin, s.end), judged = judge_distance(scene.graph, scene.root, s.at(t));
      const double slack = 1e-12 * std::max(1.0, std::abs(judged));  // for the judge's rounding errors
      INFO("seed " << seed << " at " << t << ": " << judged << " in " << print(line.value));
      CHECK((judged >= line.value.lo - slack && judged <= line.value.hi + slack));
    }
  }
}

TEST_CASE("along a line: past a sphere's centre the derivative is nearly what it is", "[number][along]") {
  vm::Workspace workspace;
  const vm::VerifiedProgram ball = primitive_program(Kind::Sphere, {1});
  for (const double miss : {0.0, 0.5, 2.0}) {
    const auto exact = [&](double t) { return t / std::hypot(t, miss); };  // increases with t
    for (double t = -4; t < 4; t += 0.25) {
      for (const double width : {1e-6, 1e-3, 0.1}) {
        if (miss == 0 && t <= 0 && t + width >= 0) continue;
        INFO("from " << t << " by " << width << ", past at " << miss);
        const vm::AlongLine line = along(ball, {{0, miss, 0}, {1, 0, 0}, t, t + width}, workspace);
        CHECK(line.derivative.lo <= exact(t) + 1e-12);
        CHECK(line.derivative.hi >= exact(t + width) - 1e-12);
        CHECK(line.derivative.lo >= exact(t) - 2 * width / std::max(miss, std::abs(t)) - 1e-12);
        CHECK(line.derivative.hi <= exact(t + width) + 2 * width / std::max(miss, std::abs(t)) + 1e-12);
        CHECK(line.value.hi - line.value.lo <= 2 * width + 1e-12);
      }
    }
  }
  // The field decreases all the way in, increases all the way out, and never changes faster than the point moves.
  CHECK(along(ball, {{0, 0.5, 0}, {1, 0, 0}, -10, -1e-3}, workspace).derivative.hi < 0);
  CHECK(along(ball, {{0, 0.5, 0}, {1, 0, 0}, 1e-3, 10}, workspace).derivative.lo > 0);
  const vm::AlongLine through = along(ball, {{0, 0, 0}, {2, 0, 0}, -3, 3}, workspace);
  CHECK((through.derivative.lo <= -2 && through.derivative.lo >= -2 - 1e-9));
  CHECK((through.derivative.hi >= 2 && through.derivative.hi <= 2 + 1e-9));
  CHECK(through.value.lo <= -1);
  CHECK(through.value.hi >= 5);
}

TEST_CASE("along a line: the derivative of a blend is between its operands'", "[number][along]") {
  vm::Workspace workspace;
  const std::vector<std::pair<Kind, std::vector<double>>> planes = {{Kind::Plane, {1, 0, 0, 0}},
                                                                    {Kind::Plane, {0, 1, 0, 0}}};
  for (const Kind kind : {Kind::SmoothUnion, Kind::SmoothIntersection}) {
    const vm::VerifiedProgram blend = over(kind, {0.5}, planes);
    const vm::AlongLine line = along(blend, {{0, 0, 0}, {0.75, 0.25, 0}, -1, 1}, workspace);
    CHECK(line.derivative.lo <= 0.25);
    CHECK(line.derivative.hi >= 0.75);
    CHECK(line.derivative.lo >= 0.25 - 1e-12);
    CHECK(line.derivative.hi <= 0.75 + 1e-12);
    // If one operand is far below the other, the blend is that operand.
    const vm::AlongLine away = along(blend, {{5, 0, 0}, {0.75, 0.25, 0}, -1, 1}, workspace);
    const double alone = kind == Kind::SmoothUnion ? 0.25 : 0.75;
    INFO(print(line.derivative) << ", away " << print(away.derivative));
    CHECK((away.derivative.lo <= alone && away.derivative.hi >= alone));
  }
}

TEST_CASE("along a line: polygons and ellipses change no faster than the line, and not at all across",
          "[number][along]") {
  vm::Workspace workspace;
  const std::pair<Kind, std::vector<double>> outlines[] = {{Kind::Polygon, {0, 0, 2, 0, 2, 1, 0.5, 1.5}},
                                                           {Kind::Ellipse, {1.5, 0.5}}};
  for (const auto& [kind, params] : outlines) {
    const vm::VerifiedProgram outline = primitive_program(kind, params);
    for (const double length : {1e-6, 0.1, 3.0}) {
      INFO(compiler::spec(kind).name << " over " << length);
      const vm::AlongLine sloped = along(outline, {{-1, 0.25, 0}, {0.6, 0, 0.8}, 0, length}, workspace);
      CHECK(sloped.derivative.lo >= -0.6 - 1e-12);
      CHECK(sloped.derivative.hi <= 0.6 + 1e-12);
      CHECK(sloped.value.hi - sloped.value.lo <= 2 * 0.6 * length + 1e-9);
      const vm::AlongLine across = along(outline, {{-1, 0.25, 0}, {0, 0, 1}, 0, length}, workspace);
      CHECK(across.derivative.lo >= -1e-12);
      CHECK(across.derivative.hi <= 1e-12);
      CHECK(across.value.hi - across.value.lo <= 1e-9);
    }
  }
}

TEST_CASE("along a line: where copies change the derivative has no bound, within a cell it has", "[number][along]") {
  vm::Workspace workspace;
  const vm::VerifiedProgram row = over(Kind::Repetition, {2, 0, 0, 9, 0, 0, 0, 0, 0}, {{Kind::Sphere, {0.5}}});
  const vm::AlongLine within = along(row, {{0, 0.25, 0}, {1, 0, 0}, -0.75, -0.25}, workspace);
  INFO("within " << print(within.derivative));
  CHECK(within.derivative.lo >= -1 - 1e-9);
  CHECK(within.derivative.hi <= 1 + 1e-9);
  const vm::AlongLine beyond = along(row, {{0, 0.25, 0}, {1, 0, 0}, 0.5, 2.5}, workspace);
  CHECK(beyond.derivative.lo == -kInf);
  CHECK(beyond.derivative.hi == kInf);
  CHECK(finite(beyond.value));
}

TEST_CASE("along a line: steps are flat between their jumps", "[number][along][formula]") {
  vm::Workspace workspace;
  for (const Opcode opcode : {Opcode::Floor, Opcode::Ceil, Opcode::Nearest, Opcode::Sign}) {
    const vm::VerifiedProgram step = formula({{Opcode::X}, {opcode}});
    INFO(vm::info(opcode).mnemonic);
    const vm::AlongLine flat = along(step, {{0, 0, 0}, {1, 0, 0}, 0.125, 0.375}, workspace);
    CHECK((flat.derivative.lo == 0 && flat.derivative.hi == 0));
    const vm::AlongLine jump = along(step, {{0, 0, 0}, {1, 0, 0}, -0.75, 0.75}, workspace);
    CHECK((jump.derivative.lo == -kInf && jump.derivative.hi == kInf));
  }
}

}  // namespace fathom::test::along_test
