// Enclosures: every value that the f32 machine computes in a box lies within the bounds, for every opcode. The bounds
// are close to the exact range, if that is known.
#include <bit>
#include <cstdint>
#include <set>

#include "tests/vm/range/boxes.h"

namespace fathom::test::enclosure_test {
namespace {

using vm::Opcode;

void add_opcodes(const vm::VerifiedProgram& program, std::set<Opcode>& seen) {
  const auto& words = program.program().words;
  for (std::size_t i = 0; i < words.size(); i += vm::instruction_length(words[i]))
    seen.insert(static_cast<Opcode>(words[i] & 0xff));
}

// Boxes whose x interval spans `steps` floats, from a start of any magnitude or between -2 and 2.
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
    // y, the second operand: a point, a small range or a large one.
    boxes.lo[1][i] = static_cast<float>(random.chance(0.3) ? random.below(9) - 4 : random.uniform(-4, 4));
    boxes.hi[1][i] = boxes.lo[1][i] + static_cast<float>(random.chance(0.5) ? 0 : random.length(1e-6, 2));
  }
  return boxes;
}

// A primitive's parameters with every length `scale` times as large.
std::vector<double> enlarged(compiler::Kind kind, std::vector<double> params, double scale) {
  std::size_t at = 0;
  for (const compiler::ParamSpec& param : compiler::spec(kind).params) {
    const bool length = param.type != compiler::ParamType::Integer && param.name.find("angle") == param.name.npos;
    const std::size_t count = param.type == compiler::ParamType::Vec3     ? 3
                              : param.type == compiler::ParamType::Vec2   ? 2
                              : param.type == compiler::ParamType::Points ? params.size() - at
                                                                          : 1;
    for (const std::size_t end = at + count; at < end; ++at) params[at] *= length ? scale : 1;
  }
  return params;
}

// FloatInterval of a program's values in a box.
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

}  // namespace

TEST_CASE("what the f32 machine computes is within its enclosure, of every opcode", "[range][enclosure][heavy]") {
  vm::Workspace workspace;
  std::set<Opcode> seen;
  int outside = 0, bounded = 0, boxes_tried = 0;
  for (std::uint64_t seed = 0; seed < 3000 && outside < 20; ++seed) {
    Random random(seed);
    const BoxSample sampled = sample(seed, random);
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

TEST_CASE("enclosures hold of shapes of a thousand units, whose errors are those of their size",
          "[range][enclosure]") {
  vm::Workspace workspace;
  Random random(8);
  for (const compiler::Sort sort : {compiler::Sort::Solid, compiler::Sort::Outline}) {
    for (const compiler::Kind kind : primitive_kinds(sort, false)) {
      for (int n = 0; n < 6; ++n) {
        const auto program = primitive_program(kind, enlarged(kind, random_params(kind, random), 1024));
        BoxSet boxes = random_boxes(random);
        for (std::size_t i = 0; i < kEnclosedBoxes; i += 2) {  // every other box lies about as far out as the shape
          for (int axis = 0; axis < 3; ++axis) {
            const float by = static_cast<float>(random.uniform(-2000, 2000));
            boxes.lo[axis][i] += by, boxes.hi[axis][i] += by;
          }
        }
        const Enclosed result = enclosed(program, boxes, workspace);
        const Cloud cloud = points_in(boxes, random, 24);
        count_outside(distances(program, cloud, workspace), cloud, result.lo, result.hi,
                      std::string(compiler::spec(kind).name));
      }
    }
  }
}

TEST_CASE("enclosures of functions hold every float of short runs", "[range][enclosure][elementary]") {
  vm::Workspace workspace;
  Random random(3);
  for (int i = 0; i < vm::kOpcodeCount; ++i) {
    const vm::OpcodeInfo& info = *vm::find_opcode(static_cast<std::uint32_t>(i));
    if (info.effect.values_needed == 0 || info.form == vm::Form::Machine || info.immediates > 0) continue;
    std::vector<Step> steps = {{Opcode::X}};
    if (info.effect.values_needed > 1) steps.push_back({Opcode::Y});
    if (info.effect.values_needed > 2) steps.push_back({Opcode::Z});
    steps.push_back({info.opcode});
    const vm::VerifiedProgram program = formula(steps);
    int outside = 0;
    for (int n = 0; n < 140 && outside < 5; ++n) {
      static const std::uint32_t kSteps[] = {0, 1, 8, 64, 1000, 100000, 4000000};
      const BoxSet boxes = runs_of_floats(random, kSteps[n % 7]);
      const Enclosed result = enclosed(program, boxes, workspace);
      Cloud cloud = points_in(boxes, random, 64);
      if (const std::uint32_t run = kSteps[n % 7]; run <= 64) {  // each float of the run in turn
        for (std::size_t at = 0; at < cloud.size(); ++at) {
          const std::size_t box = at / 64;
          cloud.x[at] = at % 64 == 0 ? boxes.lo[0][box] : std::nextafter(cloud.x[at - 1], boxes.hi[0][box]);
        }
      }
      const auto values = distances(program, cloud, workspace);
      outside += count_outside(values, cloud, result.lo, result.hi, std::string(info.mnemonic)) > 0;
    }
    CHECK(outside == 0);
  }
}

TEST_CASE("at a point an enclosure is the value, and kernels widen it by a few units in the last place",
          "[range][enclosure]") {
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

TEST_CASE("enclosures where the answer is known", "[range][enclosure]") {
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
  // If the second operand of min or max is NaN, the result is NaN. If the first operand is NaN, the result is the
  // second operand.
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

TEST_CASE("enclosures are the same bits on every instruction set", "[range][enclosure][isa]") {
  const IsaGuard guard;
  vm::Workspace workspace;
  for (std::uint64_t seed = 0; seed < 240; ++seed) {
    Random random(seed);
    const BoxSample sampled = sample(seed, random);
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

}  // namespace fathom::test::enclosure_test
