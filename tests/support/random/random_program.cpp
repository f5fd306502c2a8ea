#include "tests/support/random/random_program.h"

#include <bit>
#include <cmath>
#include <utility>
#include <variant>

#include "vm/program/check.h"

namespace fathom::test {
namespace {

using vm::Form;
using vm::Opcode;
using vm::Source;

constexpr std::uint32_t kLocals = 5;

// Builds a program while tracking the heights of the stacks and the locals that have been written.
class Builder {
 public:
  explicit Builder(Random& random) : random_(random) {
    program_.locals = kLocals;
    if (random_.chance(0.8)) program_.source_name = random_.chance(0.5) ? "scene.json" : "a \"b\"\\\n;@.json";
  }

  void add_any() {
    const vm::OpcodeInfo& row = *vm::find_opcode(static_cast<std::uint32_t>(random_.below(vm::kOpcodeCount)));
    if (points_ > 20 && row.form == Form::Point) return;
    if (row.opcode == Opcode::Drop && points_ == 1) return;
    const std::uint32_t operand = random_operand(row);
    const vm::StackEffect effect = vm::effect_of(vm::opcode_word(row.opcode, operand));
    const bool reads_local = row.opcode == Opcode::Load && !written_[operand];
    if (values_ >= effect.values_needed && !reads_local) add(row, operand);
  }

  vm::VerifiedProgram finish() {
    while (points_ > 1) add(vm::info(Opcode::Drop), 0);
    if (values_ == 0) add(vm::info(Opcode::Sphere), 0);
    while (values_ > 1) add(vm::info(Opcode::Min), 0);
    if (random_.chance(0.2)) program_.debug.clear();
    auto verified = vm::verify(std::move(program_));
    CHECK(std::holds_alternative<vm::VerifiedProgram>(verified), "a random program verifies");
    return std::get<vm::VerifiedProgram>(std::move(verified));
  }

 private:
  std::uint32_t random_operand(const vm::OpcodeInfo& row) {
    if (row.opcode == Opcode::Tag) return static_cast<std::uint32_t>(random_.below(1 << 20));
    if (row.opcode == Opcode::Tee || row.opcode == Opcode::Load) return random_local();
    if (row.form == Form::Outline)
      return vm::minimum_groups(row.opcode) + static_cast<std::uint32_t>(random_.below(4));
    if (row.form == Form::Shape) return static_cast<std::uint32_t>(random_.below(4));
    if ((row.form != Form::Unary && row.form != Form::Binary) || random_.chance(0.3)) return 0;
    vm::Sources sources;
    sources.a = random_source();
    if (row.form == Form::Binary) sources.b = random_source();
    const std::uint32_t local = random_local();
    const bool uses_local = sources.a == Source::Local || sources.b == Source::Local;
    if (uses_local && !written_[local]) return 0;
    if (uses_local) sources.local = local;
    return vm::operand_of(sources);
  }
  Source random_source() { return static_cast<Source>(random_.below(static_cast<int>(Source::Local) + 1)); }
  std::uint32_t random_local() { return static_cast<std::uint32_t>(random_.below(kLocals)); }

  void add(const vm::OpcodeInfo& row, std::uint32_t operand) {
    const std::uint32_t word = vm::opcode_word(row.opcode, operand);
    const std::size_t leading = static_cast<std::size_t>(vm::leading_immediates(word));
    std::vector<double> immediates;
    for (std::size_t i = 0; i + 1 < vm::instruction_length(word); ++i) {
      const int own =
          static_cast<int>((i - leading) % static_cast<std::size_t>(row.immediates == 0 ? 1 : row.immediates));
      const bool integer = i >= leading && vm::is_integer_immediate(row, own);
      immediates.push_back(integer ? 1 + random_.below(static_cast<int>(vm::largest_integer(row, own)))
                                   : random_constant(random_));
    }
    program_.append(row.opcode, row.form == Form::Outline ? 0 : operand, immediates, random_place());
    const vm::StackEffect effect = vm::effect_of(word);
    values_ += effect.values_change;
    points_ += effect.points_change;
    if (row.opcode == Opcode::Tee) written_[operand] = true;
  }

  vm::DebugEntry random_place() {
    constexpr const char* kSymbols[] = {
        "", "sphere", "sphere \"ball\"", "box \"; @3:4 \\\"", "union \"a\nb\t\x01 \"", " ", "ä\r"};
    vm::DebugEntry entry{0, 0, 0, kSymbols[random_.below(7)]};
    if (random_.chance(0.9)) {
      entry.line = 1 + static_cast<std::uint32_t>(random_.below(100000));
      entry.column = static_cast<std::uint32_t>(random_.below(200));
    }
    return entry;
  }

  Random& random_;
  vm::Program program_;
  int values_ = 0, points_ = 1;
  bool written_[kLocals] = {};
};

}  // namespace

double random_constant(Random& random) {
  switch (random.below(4)) {
    case 0:
      return random.below(21) - 10;
    case 1:
      return (random.below(2001) - 1000) / 100.0;
    case 2:
      return random.uniform(-2, 2);
    default:
      break;
  }
  for (;;) {
    const double value = std::bit_cast<double>(random.bits());
    if (std::isfinite(static_cast<float>(value))) return value;
  }
}

vm::VerifiedProgram random_program(Random& random, int instructions) {
  Builder builder(random);
  for (int i = 0; i < instructions; ++i) builder.add_any();
  return builder.finish();
}

}  // namespace fathom::test
