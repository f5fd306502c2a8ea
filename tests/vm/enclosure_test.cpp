// Enclosures: whatever the f32 machine computes in a box is within the bounds, of every opcode, and the bounds are
// close where what they should be is known.
#include <algorithm>
#include <bit>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include "compiler/compile.h"
#include "tests/support/compiled.h"
#include "tests/vm/float_bits.h"
#include "tests/vm/formula.h"
#include "vm/enclose.h"

namespace fathom::test {
namespace {

using compiler::Kind;
using vm::kEnclosedBoxes;
using vm::Opcode;

constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr float kLargest = std::numeric_limits<float>::max();

struct BoxSet {
  float lo[3][kEnclosedBoxes], hi[3][kEnclosedBoxes];
  vm::Boxes view() const { return {{lo[0], lo[1], lo[2]}, {hi[0], hi[1], hi[2]}}; }
};

// From points to a hundred units, flat ones and unbounded ones too, about where shapes are.
BoxSet random_boxes(Random& random) {
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

// A float of [lo, hi]: its ends, or anything between; where there is no end, of any size.
float random_within(Random& random, float lo, float hi) {
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

bool holds(float lo, float hi, float value) {
  return lo <= hi && (std::isnan(value) ? lo == -kInf && hi == kInf : lo <= value && value <= hi);
}

// `count` points of each box, one box after the other.
Cloud points_in(const BoxSet& boxes, Random& random, int count) {
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

std::vector<float> distances(const vm::VerifiedProgram& program, const Cloud& cloud, vm::Workspace& workspace) {
  std::vector<float> d(cloud.size());
  vm::evaluate_distance(program, cloud.from(0), cloud.size(), d.data(), workspace);
  return d;
}

// How many values, of points_in(), are not within [lo, hi] of their box. Reports the first.
int count_outside(const std::vector<float>& values, const Cloud& cloud, const float* lo, const float* hi,
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
Enclosed enclosed(const vm::VerifiedProgram& program, const BoxSet& boxes, vm::Workspace& workspace) {
  Enclosed result;
  vm::enclose(program, boxes.view(), result.lo, result.hi, result.choices, workspace);
  REQUIRE(result.choices.size() == program.choices());
  return result;
}

void add_opcodes(const vm::VerifiedProgram& program, std::set<Opcode>& seen) {
  const auto& words = program.program().words;
  for (std::size_t i = 0; i < words.size(); i += vm::instruction_length(words[i]))
    seen.insert(static_cast<Opcode>(words[i] & 0xff));
}

struct Sample {
  vm::VerifiedProgram program;
  std::string name;
};

// A primitive, every kind in turn, or a graph, or a formula.
Sample sample(std::uint64_t seed, Random& random) {
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
  std::vector<Kind> kinds = primitive_kinds(compiler::Sort::Solid, true);
  const std::vector<Kind> outlines = primitive_kinds(compiler::Sort::Outline, true);
  kinds.insert(kinds.end(), outlines.begin(), outlines.end());
  const Kind kind = kinds[seed / 3 % kinds.size()];
  return {primitive_program(kind, random_params(kind, random)),
          number + ": " + std::string(compiler::spec(kind).name)};
}

// The program up to the word `end`, then what makes its result the upper of the two values there, or the lower: one
// is copied to a local; what is left on the stack is made into a number of no account, and the copy added or taken.
vm::VerifiedProgram operand_program(const vm::VerifiedProgram& whole, std::size_t end, bool upper) {
  const vm::Program& from = whole.program();
  vm::Program code;
  code.locals = from.locals + 1;
  code.words.assign(from.words.begin(), from.words.begin() + static_cast<std::ptrdiff_t>(end));
  code.wide.assign(from.wide.begin(), from.wide.begin() + static_cast<std::ptrdiff_t>(end));
  int values = 0, points = 1;
  for (std::size_t at = 0; at < end; at += vm::instruction_length(code.words[at])) {
    const vm::StackEffect effect = vm::effect_of(code.words[at]);
    values += effect.values_change, points += effect.points_change;
  }
  const std::uint32_t local = from.locals;
  const auto below_all = [&] {  // the top value becomes -3.4e38 or -infinity, whatever it was
    code.append(Opcode::Constant, 0, {-kLargest}, {});
    code.append(Opcode::Min, 0, {}, {});
  };
  if (!upper) {
    below_all();
    code.append(Opcode::Sign, 0, {}, {});
    code.append(Opcode::Constant, 0, {1}, {});
    code.append(Opcode::Add, 0, {}, {});  // 0
    code.append(Opcode::Add, 0, {}, {});
    --values;
  }
  code.append(Opcode::Tee, local, {}, {});
  for (; values > 1; --values) code.append(Opcode::Min, 0, {}, {});
  below_all();
  code.append(Opcode::Load, local, {}, {});
  code.append(Opcode::And, 0, {}, {});  // the second, as the first is not 0
  for (; points > 1; --points) code.append(Opcode::Drop, 0, {}, {});
  return verified(std::move(code));
}

}  // namespace

TEST_CASE("what the f32 machine computes is within its enclosure, of every opcode", "[enclosure][heavy]") {
  vm::Workspace workspace;
  std::set<Opcode> seen;
  int outside = 0, bounded = 0, boxes_tried = 0;
  for (std::uint64_t seed = 0; seed < 6000 && outside < 20; ++seed) {
    Random random(seed);
    const Sample sampled = sample(seed, random);
    add_opcodes(sampled.program, seen);
    const BoxSet boxes = random_boxes(random);
    const Enclosed result = enclosed(sampled.program, boxes, workspace);
    const Cloud cloud = points_in(boxes, random, 24);
    const std::vector<float> values = distances(sampled.program, cloud, workspace);
    outside += count_outside(values, cloud, result.lo, result.hi, sampled.name) > 0;
    for (std::size_t i = 0; i < kEnclosedBoxes; ++i) bounded += result.hi[i] - result.lo[i] < 1e6;
    boxes_tried += kEnclosedBoxes;
  }
  for (int i = 0; i < vm::kOpcodeCount; ++i) {
    const vm::OpcodeInfo& info = *vm::find_opcode(static_cast<std::uint32_t>(i));
    INFO(info.mnemonic);
    CHECK((info.form == vm::Form::Machine || seen.count(static_cast<Opcode>(i)) == 1));
  }
  INFO(bounded << " of " << boxes_tried << " enclosures are bounded");
  CHECK(bounded > 0.6 * boxes_tried);
}

TEST_CASE("the operands of every choice are within their bounds", "[enclosure]") {
  vm::Workspace workspace;
  int outside = 0, compared = 0;
  for (std::uint64_t seed = 0; seed < 150 && outside < 20; ++seed) {
    Random random(seed);
    const Sample sampled = sample(seed % 2 == 0 ? 3 * seed : 3 * seed + 1, random);
    const BoxSet boxes = random_boxes(random);
    const Enclosed result = enclosed(sampled.program, boxes, workspace);
    const Cloud cloud = points_in(boxes, random, 8);
    const auto& words = sampled.program.program().words;
    std::size_t choice = 0;
    for (std::size_t at = 0; at < words.size(); at += vm::instruction_length(words[at])) {
      if (!vm::is_choice(words[at])) continue;
      REQUIRE(vm::operand_of(words[at]) == 0);
      const vm::ChoiceBounds& bounds = result.choices[choice++];
      const auto a = distances(operand_program(sampled.program, at, false), cloud, workspace);
      const auto b = distances(operand_program(sampled.program, at, true), cloud, workspace);
      const std::string name = sampled.name + ", choice at " + std::to_string(at);
      outside += count_outside(a, cloud, bounds.a_lo, bounds.a_hi, name + ", a") > 0;
      outside += count_outside(b, cloud, bounds.b_lo, bounds.b_hi, name + ", b") > 0;
      ++compared;
    }
    CHECK(choice == result.choices.size());
  }
  CHECK(compared > 300);
}

TEST_CASE("enclosures of fused programs are those of plain ones, choice for choice", "[enclosure]") {
  vm::Workspace workspace;
  Random random(5);
  const std::string objects = R"({"type": "sphere", "radius": 1}, {"type": "box", "half_size": [1, 0.5, 2]},
    {"type": "sphere", "radius": 0.5, "translate": [2, 0, 1]},
    {"type": "subtraction", "children": [{"type": "torus", "major": 2, "minor": 0.3}, {"type": "sphere", "radius": 2}]})";
  compiler::CompileOptions plain;
  plain.stop_after = std::string(compiler::pass_names()[compiler::pass_names().size() - 2]);
  const auto a = tests::compiled_objects(objects).distance, b = tests::compiled_objects(objects, plain).distance;
  REQUIRE(a.instructions() < b.instructions());
  REQUIRE(a.choices() == b.choices());
  for (int i = 0; i < 20; ++i) {
    const BoxSet boxes = random_boxes(random);
    const Enclosed fused = enclosed(a, boxes, workspace), split = enclosed(b, boxes, workspace);
    for (std::size_t box = 0; box < kEnclosedBoxes; ++box) {
      CHECK((fused.lo[box] == split.lo[box] && fused.hi[box] == split.hi[box]));
      for (std::size_t n = 0; n < fused.choices.size(); ++n) {
        CHECK(fused.choices[n].a_lo[box] == split.choices[n].a_lo[box]);
        CHECK(fused.choices[n].a_hi[box] == split.choices[n].a_hi[box]);
        CHECK(fused.choices[n].b_lo[box] == split.choices[n].b_lo[box]);
        CHECK(fused.choices[n].b_hi[box] == split.choices[n].b_hi[box]);
      }
    }
  }
}

// Boxes whose x ranges over `steps` floats from one of any size on, or from -2 to 2.
BoxSet runs_of_floats(Random& random, std::uint32_t steps) {
  BoxSet boxes{};
  for (std::size_t i = 0; i < kEnclosedBoxes; ++i) {
    float lo = random.chance(0.5) ? static_cast<float>(random.uniform(-2, 2))
                                  : std::bit_cast<float>(static_cast<std::uint32_t>(random.bits()));
    if (!std::isfinite(lo)) lo = 0;
    float hi = lo;
    if (steps > 64) {
      hi = lo + std::abs(lo) * 0x1p-23f * static_cast<float>(steps);
    } else {
      for (std::uint32_t n = 0; n < steps; ++n) hi = std::nextafter(hi, kInf);
    }
    boxes.lo[0][i] = lo, boxes.hi[0][i] = std::min(hi, kLargest);
    // Of the second operand: a point, a small range, a large one.
    boxes.lo[1][i] = static_cast<float>(random.chance(0.3) ? random.below(9) - 4 : random.uniform(-4, 4));
    boxes.hi[1][i] = boxes.lo[1][i] + static_cast<float>(random.chance(0.5) ? 0 : random.length(1e-6, 2));
  }
  return boxes;
}

TEST_CASE("enclosures of functions hold every float of short runs", "[enclosure][elementary]") {
  vm::Workspace workspace;
  Random random(3);
  for (int i = 0; i < vm::kOpcodeCount; ++i) {
    const vm::OpcodeInfo& info = *vm::find_opcode(static_cast<std::uint32_t>(i));
    if ((info.form != vm::Form::Unary && info.form != vm::Form::Binary) || info.immediates > 0) continue;
    std::vector<Step> steps = {{Opcode::X}};
    if (info.form == vm::Form::Binary) steps.push_back({Opcode::Y});
    steps.push_back({info.opcode});
    const vm::VerifiedProgram program = formula(steps);
    int outside = 0;
    for (int n = 0; n < 400 && outside < 5; ++n) {
      static const std::uint32_t kSteps[] = {0, 1, 8, 64, 1000, 100000, 4000000};
      const BoxSet boxes = runs_of_floats(random, kSteps[n % 7]);
      const Enclosed result = enclosed(program, boxes, workspace);
      Cloud cloud = points_in(boxes, random, 64);
      for (std::size_t at = 0; at < cloud.size(); ++at) {  // each float in turn where the run is short
        float x = boxes.lo[0][at / 64];
        if (kSteps[n % 7] > 64) continue;
        for (std::size_t step = 0; step < at % 64; ++step) x = std::nextafter(x, kInf);
        cloud.x[at] = std::min(x, boxes.hi[0][at / 64]);
      }
      const auto values = distances(program, cloud, workspace);
      outside += count_outside(values, cloud, result.lo, result.hi, std::string(info.mnemonic)) > 0;
    }
    CHECK(outside == 0);
  }
}

TEST_CASE("at a point an enclosure is the value, and kernels widen it by a few units in the last place",
          "[enclosure]") {
  vm::Workspace workspace;
  Random random(4);
  const Opcode exact[] = {Opcode::Abs,     Opcode::Square, Opcode::Sqrt, Opcode::Floor, Opcode::Ceil,
                          Opcode::Nearest, Opcode::Sign,   Opcode::Not,  Opcode::Negate};
  const Opcode kernels[] = {Opcode::Sin,  Opcode::Cos,  Opcode::Tan, Opcode::Asin,
                            Opcode::Acos, Opcode::Atan, Opcode::Exp, Opcode::Log};
  const auto check = [&](Opcode opcode, double share) {
    const vm::VerifiedProgram program = formula({{Opcode::X}, {opcode}});
    for (int n = 0; n < 50; ++n) {
      BoxSet boxes{};
      Cloud cloud;
      for (std::size_t i = 0; i < kEnclosedBoxes; ++i) {
        const float x =
            static_cast<float>(random.uniform(opcode == Opcode::Sqrt || opcode == Opcode::Log ? 0 : -1, 1));
        boxes.lo[0][i] = boxes.hi[0][i] = x;
        cloud.add(x, 0, 0);
      }
      const Enclosed result = enclosed(program, boxes, workspace);
      const auto values = distances(program, cloud, workspace);
      for (std::size_t i = 0; i < kEnclosedBoxes; ++i) {
        INFO(vm::info(opcode).mnemonic << " of " << cloud.x[i] << " in " << result.lo[i] << " .. " << result.hi[i]);
        CHECK(values[i] - result.lo[i] <= share * std::abs(values[i]));
        CHECK(result.hi[i] - values[i] <= share * std::abs(values[i]));
      }
    }
  };
  for (const Opcode opcode : exact) check(opcode, 0);
  for (const Opcode opcode : kernels) check(opcode, 0x1p-19);
}

// What a program gives in a box.
vm::Range range_in(const vm::VerifiedProgram& program, glm::vec3 lo, glm::vec3 hi) {
  vm::Workspace workspace;
  BoxSet boxes;
  for (int axis = 0; axis < 3; ++axis) {
    std::fill_n(boxes.lo[axis], kEnclosedBoxes, lo[axis]);
    std::fill_n(boxes.hi[axis], kEnclosedBoxes, hi[axis]);
  }
  const Enclosed result = enclosed(program, boxes, workspace);
  for (std::size_t i = 1; i < kEnclosedBoxes; ++i) {
    CHECK((result.lo[i] == result.lo[0] && result.hi[i] == result.hi[0]));
  }
  return {result.lo[0], result.hi[0]};
}

TEST_CASE("enclosures where the answer is known", "[enclosure]") {
  const auto is = [](vm::Range range, double lo, double hi) { return range.lo == lo && range.hi == hi; };
  const auto square_less_one = formula({{Opcode::X}, {Opcode::Square}, {Opcode::Constant, {1}}, {Opcode::Minus}});
  CHECK(is(range_in(square_less_one, {-1, 0, 0}, {2, 0, 0}), -1, 3));
  const auto quotient = formula({{Opcode::X}, {Opcode::Y}, {Opcode::Divide}});
  CHECK(is(range_in(quotient, {1, 2, 0}, {3, 4, 0}), 0.25, 1.5));
  CHECK(is(range_in(quotient, {-1, -4, 0}, {3, -2, 0}), -1.5, 0.5));
  CHECK(is(range_in(quotient, {1, -1, 0}, {3, 4, 0}), -kInf, kInf));
  const auto root = formula({{Opcode::X}, {Opcode::Sqrt}});
  CHECK(is(range_in(root, {4, 0, 0}, {9, 0, 0}), 2, 3));
  CHECK(is(range_in(root, {-1, 0, 0}, {9, 0, 0}), -kInf, kInf));
  const auto product = formula({{Opcode::X}, {Opcode::Y}, {Opcode::Multiply}});
  CHECK(is(range_in(product, {-kInf, 0, 0}, {kInf, 0, 0}), 0, 0));  // points are finite
  CHECK(is(range_in(product, {1, 2, 0}, {kInf, 3, 0}), 2, kInf));   // and products may overflow
  // A number that may be NaN stays one through min and max, unless it is the first operand: then it is the second.
  const auto after = [](Opcode opcode, bool first) {
    std::vector<Step> steps = {{Opcode::X}, {Opcode::Sqrt}};
    steps.insert(first ? steps.end() : steps.begin(), Step{Opcode::Constant, {5}});
    steps.push_back({opcode});
    return range_in(formula(steps), {-1, 0, 0}, {1, 0, 0});
  };
  CHECK(is(after(Opcode::Min, true), -kInf, 5));
  CHECK(is(after(Opcode::Max, true), 5, kInf));
  CHECK(is(after(Opcode::Min, false), -kInf, kInf));
  CHECK(is(after(Opcode::Max, false), -kInf, kInf));
  const auto waves = formula({{Opcode::X}, {Opcode::Sin}});
  CHECK(is(range_in(waves, {1, 0, 0}, {10, 0, 0}), -1, 1));
  CHECK(range_in(waves, {2, 0, 0}, {4, 0, 0}).lo == Approx(std::sin(4.0)));
  CHECK(range_in(waves, {2, 0, 0}, {4, 0, 0}).hi == Approx(std::sin(2.0)));
  CHECK(is(range_in(waves, {1e30f, 0, 0}, {1e30f, 0, 0}), -1, 1));
}

TEST_CASE("a choice between far spheres is decided, between near ones it is not", "[enclosure]") {
  vm::Program code;
  code.append(Opcode::Sphere, 0, {1}, {});
  code.append(Opcode::Sphere, vm::kMoved | vm::kJoined, {4, 0, 0, 1}, {});
  const vm::VerifiedProgram program = verified(std::move(code));
  REQUIRE(program.choices() == 1);
  vm::Workspace workspace;
  BoxSet boxes{};
  for (std::size_t i = 0; i < kEnclosedBoxes; ++i) {  // small cubes along x from -1 to 6.5
    for (int axis = 0; axis < 3; ++axis) boxes.lo[axis][i] = -0.1f, boxes.hi[axis][i] = 0.1f;
    boxes.lo[0][i] += static_cast<float>(i) / 2 - 1, boxes.hi[0][i] += static_cast<float>(i) / 2 - 1;
  }
  const Enclosed result = enclosed(program, boxes, workspace);
  for (std::size_t i = 0; i < kEnclosedBoxes; ++i) {
    const double x = static_cast<double>(i) / 2 - 1;
    const vm::ChoiceBounds& choice = result.choices[0];
    CHECK((choice.a_hi[i] < choice.b_lo[i]) == (x < 1.8));
    CHECK((choice.b_hi[i] < choice.a_lo[i]) == (x > 2.2));
    CHECK(choice.a_hi[i] - choice.a_lo[i] < 2.01 * std::sqrt(0.03));
  }
}

// An instruction of its own, from one of random programs. [word]
struct Row {
  vm::Program code;
  std::string name;
};
std::vector<Row> rows_of(const vm::VerifiedProgram& program, vm::Form form) {
  const vm::Program& from = program.program();
  std::vector<Row> rows;
  for (std::size_t at = 0; at < from.words.size(); at += vm::instruction_length(from.words[at])) {
    const vm::OpcodeInfo& info = *vm::find_opcode(from.words[at] & 0xff);
    const bool shape = info.form == vm::Form::Shape || info.form == vm::Form::Outline;
    if (form == vm::Form::Shape ? !shape : info.form != form) continue;
    if (!vm::is_nonexpansive(info.opcode)) continue;
    Row row;
    const auto begin = static_cast<std::ptrdiff_t>(at);
    const auto end = begin + static_cast<std::ptrdiff_t>(vm::instruction_length(from.words[at]));
    row.code.words.assign(from.words.begin() + begin, from.words.begin() + end);
    row.code.wide.assign(from.wide.begin() + begin, from.wide.begin() + end);
    row.name = std::string(info.mnemonic);
    for (std::size_t i = 1; i < row.code.wide.size(); ++i) row.name += " " + std::to_string(row.code.wide[i]);
    rows.push_back(std::move(row));
  }
  return rows;
}

// The row's value at p, or the point it makes of p.
glm::dvec3 image_of(const std::vector<vm::VerifiedProgram>& parts, glm::dvec3 p, vm::Workspace& workspace) {
  glm::dvec3 image(0);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    image[static_cast<int>(i)] = vm::evaluate_distance(parts[i], p, workspace);
  }
  return image;
}
std::vector<vm::VerifiedProgram> parts_of(const Row& row, vm::Form form) {
  std::vector<vm::VerifiedProgram> parts;
  if (form == vm::Form::Shape) {
    parts.push_back(verified(row.code));
    return parts;
  }
  for (const Opcode axis : {Opcode::X, Opcode::Y, Opcode::Z}) {
    vm::Program code = row.code;
    code.append(axis, 0, {}, {});
    code.append(Opcode::Drop, 0, {}, {});
    parts.push_back(verified(std::move(code)));
  }
  return parts;
}

TEST_CASE("rows said to be nonexpansive are, wherever two points lie", "[enclosure]") {
  vm::Workspace workspace;
  std::set<Opcode> seen;
  int violations = 0;
  for (std::uint64_t seed = 0; seed < 1500 && violations < 10; ++seed) {
    if (seed % 3 == 1) continue;  // formulas
    Random random(seed);
    const Sample sampled = sample(seed, random);
    for (const vm::Form form : {vm::Form::Shape, vm::Form::Point}) {
      for (const Row& row : rows_of(sampled.program, form)) {
        seen.insert(static_cast<Opcode>(row.code.words[0] & 0xff));
        const auto parts = parts_of(row, form);
        for (int i = 0; i < 40; ++i) {
          const double far = random.chance(0.2) ? random.length(1, 1e3) : 1;
          const glm::dvec3 p = random.in_box(3) * far, q = p + random.direction() * random.length(1e-5, 10) * far;
          const double apart = glm::distance(p, q);
          const double moved = glm::distance(image_of(parts, p, workspace), image_of(parts, q, workspace));
          if (moved <= apart * (1 + 1e-9) + 1e-11 * far) continue;
          ++violations;
          FAIL_CHECK(row.name << ": " << moved << " for " << apart << " at " << p.x << " " << p.y << " " << p.z);
          break;
        }
      }
    }
  }
  for (int i = 0; i < vm::kOpcodeCount; ++i) {
    const vm::OpcodeInfo& info = *vm::find_opcode(static_cast<std::uint32_t>(i));
    const bool claimed =
        info.form == vm::Form::Shape || info.form == vm::Form::Outline || info.form == vm::Form::Point;
    INFO(info.mnemonic);
    if (claimed && vm::is_nonexpansive(info.opcode)) CHECK(seen.count(info.opcode) == 1);
  }
}

TEST_CASE("enclosures are the same bits on every instruction set", "[enclosure][isa]") {
  const IsaGuard guard;
  vm::Workspace workspace;
  for (std::uint64_t seed = 0; seed < 240; ++seed) {
    Random random(seed);
    const Sample sampled = sample(seed, random);
    const BoxSet boxes = random_boxes(random);
    std::vector<std::uint32_t> first;
    for (const std::string_view isa : vm::available_isas()) {
      REQUIRE(vm::force_isa(isa));
      const Enclosed result = enclosed(sampled.program, boxes, workspace);
      std::vector<std::uint32_t> bits;
      for (std::size_t i = 0; i < kEnclosedBoxes; ++i) {
        bits.push_back(bits_of(result.lo[i])), bits.push_back(bits_of(result.hi[i]));
        for (const vm::ChoiceBounds& bounds : result.choices) {
          for (const float* f : {bounds.a_lo, bounds.a_hi, bounds.b_lo, bounds.b_hi}) bits.push_back(bits_of(f[i]));
        }
      }
      if (first.empty()) first = bits;
      INFO(sampled.name << " on " << isa);
      CHECK(bits == first);
    }
  }
}

}  // namespace fathom::test
