// Consistency tests of the opcode table. Its facts about Points and Shapes: nonexpansive_test.cpp,
// convexity_test.cpp.
#include "vm/program/opcode.h"

#include <set>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/catch.h"
#include "tests/support/plain_lowering.h"
#include "tests/support/random/random_scene.h"
#include "vm/interpret/evaluate.h"
#include "vm/program/opcode_rows.h"

namespace fathom::test::opcode_test {

using vm::Choice;
using vm::Fact;
using vm::Form;
using vm::Opcode;
using vm::OpcodeInfo;

namespace {

template <typename Check>
void for_each_opcode(const Check& check) {
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(vm::kOpcodeCount); ++i) {
    const OpcodeInfo* row = vm::find_opcode(i);
    REQUIRE(row != nullptr);
    INFO(row->mnemonic);
    check(i, *row);
  }
}

}  // namespace

TEST_CASE("every opcode has its own row and mnemonic", "[program][opcode]") {
  std::set<std::string_view> mnemonics;
  for_each_opcode([&](std::uint32_t i, const OpcodeInfo& row) {
    CHECK(static_cast<std::uint32_t>(row.opcode) == i);
    CHECK(&vm::info(row.opcode) == &row);
    CHECK(mnemonics.insert(row.mnemonic).second);
    CHECK(row.mnemonic.find_first_not_of("abcdefghijklmnopqrstuvwxyz_0123456789") == std::string_view::npos);
    CHECK(row.cost >= 0);
  });
  CHECK(vm::find_opcode(static_cast<std::uint32_t>(vm::kOpcodeCount)) == nullptr);
  CHECK(vm::find_opcode(255) == nullptr);
  CHECK(vm::find_opcode(256) == nullptr);
}

TEST_CASE("the columns at hand are the table's, and count the words of every instruction", "[program][opcode]") {
  for_each_opcode([](std::uint32_t i, const OpcodeInfo& row) {
    const vm::OpcodeRow& at_hand = vm::row_of(i);
    CHECK((at_hand.opcode == row.opcode && at_hand.form == row.form));
    CHECK((at_hand.choice == row.choice && at_hand.facts == row.facts));
    CHECK((at_hand.immediates == row.immediates && at_hand.cost == row.cost));
    // Operands: all sources of both operands with and without a local; moved and joined; up to 63 groups.
    for (std::uint32_t operand = 0; operand < 128; ++operand) {
      const std::uint32_t word = vm::opcode_word(row.opcode, operand);
      CHECK(1 + vm::immediates_of(word) == vm::instruction_length(word));
      CHECK((vm::is_joined(word) || at_hand.choice != Choice::None) == vm::is_choice(word));
    }
  });
}

TEST_CASE("immediates are counted, named and told apart", "[program][opcode]") {
  for_each_opcode([](std::uint32_t, const OpcodeInfo& row) {
    std::set<std::string_view> names;
    for (int i = 0; i < row.immediates; ++i) {
      const std::string_view name = vm::immediate_name(row, i);
      CHECK_FALSE(name.empty());
      CHECK(name.find(':') == std::string_view::npos);
      CHECK(names.insert(name).second);
    }
    CHECK(vm::immediate_name(row, row.immediates).empty());
  });
  CHECK(vm::info(Opcode::Affine).immediates == 12);
  CHECK(vm::info(Opcode::Negate).immediates == 0);
  CHECK(vm::info(Opcode::Sphere).immediates == 1);
  CHECK(vm::info(Opcode::Quad).immediates == vm::info(Opcode::Triangle).immediates + 5);
  CHECK(vm::is_integer_immediate(vm::info(Opcode::Mandelbulb), 0));
  CHECK(vm::is_integer_immediate(vm::info(Opcode::Mandelbulb), 1));
  CHECK_FALSE(vm::is_integer_immediate(vm::info(Opcode::Mandelbulb), 2));
  CHECK_FALSE(vm::is_integer_immediate(vm::info(Opcode::Sphere), 0));
  CHECK(vm::count_names("") == 0);
  CHECK(vm::count_names("  a  bc d ") == 3);
}

TEST_CASE("forms, stack effects and choices go together", "[program][opcode]") {
  for_each_opcode([](std::uint32_t, const OpcodeInfo& row) {
    const vm::StackEffect& effect = row.effect;
    CHECK(effect.values_needed + effect.values_change >= 0);
    CHECK(effect.points_needed + effect.points_change >= 0);
    if (row.form != Form::Binary) CHECK(row.choice == Choice::None);
    if (row.form != Form::Machine) CHECK(row.has_operand == (row.form == Form::Outline));
    if (row.form == Form::Shape || row.form == Form::Outline)
      CHECK((effect.values_change == 1 && effect.points_change == 0));
    if (row.form == Form::Point) CHECK((effect.values_change == 0 && effect.points_change == 1));
    if (row.form == Form::Ternary)
      CHECK((effect.values_change == -2 && effect.values_needed == 3 && row.immediates == 0));
    if (row.form == Form::Binary) CHECK((effect.values_change == -1 && effect.values_needed == 2));
  });
  CHECK(vm::info(Opcode::Tee).has_operand);
  CHECK(vm::info(Opcode::Load).has_operand);
  CHECK(vm::info(Opcode::Tag).has_operand);
  CHECK_FALSE(vm::info(Opcode::Drop).has_operand);
}

TEST_CASE("facts go with forms, and with each other", "[program][opcode]") {
  for_each_opcode([](std::uint32_t, const OpcodeInfo& row) {
    const auto has = [&](Fact fact) { return vm::has(row.facts, fact); };
    const bool shape = row.form == Form::Shape || row.form == Form::Outline;
    const bool pruned = row.choice == Choice::Lesser || row.choice == Choice::Greater || row.choice == Choice::Carve;
    CHECK(has(Fact::Both) == shape);  // each shape has a method for its range
    if (has(Fact::Affine)) CHECK(row.form == Form::Point);
    if (has(Fact::Expansive)) CHECK((row.form == Form::Point || (shape && !has(Fact::Ball))));
    if (has(Fact::Convex)) CHECK((row.form == Form::Shape && !has(Fact::Expansive)));
    if (has(Fact::Far)) CHECK((shape && has(Fact::Ball)));
    if (has(Fact::LastIsFlag)) CHECK((row.form == Form::Shape && has(Fact::Far)));
    if (has(Fact::ThreeGroups)) CHECK(row.form == Form::Outline);
    if (has(Fact::Hard)) CHECK((pruned && row.immediates == 0));
    if (has(Fact::Smooth)) CHECK((pruned && row.immediates > 0));
    if (has(Fact::Commutes)) CHECK(row.form == Form::Binary);
    if (has(Fact::Numbered)) CHECK(row.form == Form::Machine);
  });
}

// The immediates suit a smooth blend, the only row that commutes and has any.
TEST_CASE("rows said to commute do", "[program][opcode]") {
  vm::Workspace workspace;
  Random random(31);
  for_each_opcode([&](std::uint32_t, const OpcodeInfo& row) {
    if (!vm::has(row.facts, Fact::Commutes)) return;
    const double width = random.length(0.1, 1);
    std::vector<double> immediates = {width, 0.25 / width};
    immediates.resize(static_cast<std::size_t>(row.immediates));
    const auto value = [&](double a, double b) {
      vm::Program code;
      code.append(Opcode::Constant, 0, {a}, {});
      code.append(Opcode::Constant, 0, {b}, {});
      code.append(row.opcode, 0, immediates, {});
      return vm::evaluate_distance(verified(std::move(code)), glm::dvec3(0), workspace);
    };
    for (int i = 0; i < 100; ++i) {
      const double a = random.uniform(-1, 1), b = random.uniform(-1, 1);
      CHECK(value(a, b) == value(b, a));
    }
  });
}

TEST_CASE("an opcode word takes apart into what it was made of", "[program][opcode]") {
  for (std::uint32_t operand : {0u, 1u, 255u, 256u, vm::kMaxOperand}) {
    const std::uint32_t word = vm::opcode_word(Opcode::Tag, operand);
    CHECK(vm::operand_of(word) == operand);
    CHECK((word & 0xff) == static_cast<std::uint32_t>(Opcode::Tag));
  }
}

}  // namespace fathom::test::opcode_test
