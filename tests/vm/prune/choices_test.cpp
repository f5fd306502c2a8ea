// Bounds of the operands of choice instructions over boxes: they contain the operands, are equal in fused programs,
// and decide a choice where they can.
#include "compiler/compile.h"
#include "tests/support/compiled.h"
#include "tests/vm/range/boxes.h"

namespace fathom::test::choices_test {
namespace {

using vm::Opcode;

// Returns a program whose result is the top value on the stack at the word `end` (`upper`), or the value below the
// top. The program runs `whole` up to `end` and copies the value to a local. Whatever is left on the stack becomes a
// non-zero number, and `and` of that number and the local is the local.
vm::VerifiedProgram operand_program(const vm::VerifiedProgram& whole, std::size_t end, bool upper) {
  const vm::Program& from = whole.program();
  vm::Program code;
  code.locals = from.locals + 1;
  code.words.assign(from.words.begin(), from.words.begin() + static_cast<std::ptrdiff_t>(end));
  code.doubles.assign(from.doubles.begin(), from.doubles.begin() + static_cast<std::ptrdiff_t>(end));
  int values = 0, points = 1;
  for (std::size_t at = 0; at < end; at += vm::instruction_length(code.words[at])) {
    const vm::StackEffect effect = vm::effect_of(code.words[at]);
    values += effect.values_change, points += effect.points_change;
  }
  const std::uint32_t local = from.locals;
  // The top value becomes -3.4e38 or -infinity, whatever it was.
  const auto below_all = [&] {
    code.append(Opcode::Constant, 0, {-kLargest}, {});
    code.append(Opcode::Min, 0, {}, {});
  };
  if (!upper) {
    below_all();
    code.append(Opcode::Sign, 0, {}, {});
    code.append(Opcode::Constant, 0, {1}, {});
    code.append(Opcode::Add, 0, {}, {});  // the sum is 0
    code.append(Opcode::Add, 0, {}, {});
    --values;
  }
  code.append(Opcode::Tee, local, {}, {});
  for (; values > 1; --values) code.append(Opcode::Min, 0, {}, {});
  below_all();
  code.append(Opcode::Load, local, {}, {});
  code.append(Opcode::And, 0, {}, {});  // the local, since the first operand is not 0
  for (; points > 1; --points) code.append(Opcode::Drop, 0, {}, {});
  return verified(std::move(code));
}

}  // namespace

TEST_CASE("the operands of every choice are within their bounds", "[prune][enclosure]") {
  vm::Workspace workspace;
  int outside = 0, compared = 0;
  for (std::uint64_t seed = 0; seed < 150 && outside < 20; ++seed) {
    Random random(seed);
    const BoxSample sampled = sample(seed % 2 == 0 ? 3 * seed : 3 * seed + 1, random);
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

TEST_CASE("enclosures of fused programs are those of plain ones, choice for choice", "[prune][enclosure]") {
  vm::Workspace workspace;
  Random random(5);
  const std::string objects = R"({"type": "sphere", "radius": 1}, {"type": "box", "half_size": [1, 0.5, 2]},
    {"type": "sphere", "radius": 0.5, "translate": [2, 0, 1]},
    {"type": "subtraction", "of": [{"type": "torus", "major_radius": 2, "minor_radius": 0.3}, {"type": "sphere", "radius": 2}]})";
  compiler::CompileOptions plain;
  plain.stop_after = std::string(compiler::pass_names()[compiler::pass_names().size() - 2]);
  const auto a = test::compiled_objects(objects).distance, b = test::compiled_objects(objects, plain).distance;
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

TEST_CASE("a choice between far spheres is decided, between near ones it is not", "[prune][enclosure]") {
  vm::Program code;
  code.append(Opcode::Sphere, 0, {1}, {});
  code.append(Opcode::Sphere, vm::kFusedTranslate | vm::kFusedMin, {4, 0, 0, 1}, {});
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

}  // namespace fathom::test::choices_test
