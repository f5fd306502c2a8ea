// Tests of the verifier: each rule broken alone, by the smallest program that breaks it, and each limit at its edge.
#include "tests/support/catch.h"
#include "vm/program/verify.h"

#include <bit>
#include <limits>
#include <string>
#include <variant>
#include <vector>

namespace fathom::test::verify_test {
namespace {

using Catch::Contains;
using vm::Opcode;
using vm::Program;

struct Instruction {
  Opcode opcode;
  std::vector<double> immediates = {};
  std::uint32_t operand = 0;
};

Program program_of(const std::vector<Instruction>& instructions, std::uint32_t locals = 0) {
  Program program;
  program.locals = locals;
  for (const Instruction& i : instructions) program.append(i.opcode, i.operand, i.immediates, {});
  return program;
}

const Instruction kSphere{Opcode::Sphere, {1}};
const Instruction kMove{Opcode::Translate, {1, 2, 3}};
const Instruction kDrop{Opcode::Drop};
const Instruction kMin{Opcode::Min};

bool passes(Program program, const vm::Limits& limits = {}) {
  return std::holds_alternative<vm::VerifiedProgram>(vm::verify(std::move(program), limits));
}

void refused(Program program, std::uint32_t offset, const std::string& reason, const vm::Limits& limits = {}) {
  const auto result = vm::verify(std::move(program), limits);
  const auto* error = std::get_if<vm::VerifyError>(&result);
  INFO("expected at " << offset << ": " << reason);
  REQUIRE(error != nullptr);
  INFO("said at " << error->offset << ": " << error->reason);
  CHECK(error->offset == offset);
  CHECK_THAT(error->reason, Contains(reason));
}

// The default limits, modified by `change`.
template <typename Change>
vm::Limits limits_with(const Change& change) {
  vm::Limits limits;
  change(limits);
  return limits;
}

}  // namespace

TEST_CASE("a program that keeps the rules passes with its stack heights", "[program][verify]") {
  auto result = vm::verify(program_of({kMove,
                                       kSphere,
                                       {Opcode::Tee, {}, 0},
                                       kDrop,
                                       {Opcode::Load, {}, 0},
                                       kMin,
                                       {Opcode::Scale, {2}},
                                       {Opcode::Tag, {}, 7}},
                                      1));
  REQUIRE(std::holds_alternative<vm::VerifiedProgram>(result));
  const auto& program = std::get<vm::VerifiedProgram>(result);
  CHECK(program.max_values() == 2);
  CHECK(program.max_points() == 2);
  CHECK(program.instructions() == 8);
  CHECK(program.cost() == 1 + 8 + 1 + 0 + 1 + 1 + 1 + 0);
  CHECK(program.program().words.size() == 13);
}

TEST_CASE("every opcode must exist", "[program][verify]") {
  Program program = program_of({kSphere});
  program.words.push_back(vm::kOpcodeCount);
  program.doubles.push_back(0);
  refused(program, 2, "no opcode " + std::to_string(vm::kOpcodeCount));
  program.words.back() = 255;
  refused(program, 2, "no opcode 255");
}

TEST_CASE("no instruction may be cut off", "[program][verify]") {
  Program program = program_of({kSphere, {Opcode::Box, {1, 2, 3}}, kMin});
  for (std::size_t keep : {3u, 4u, 5u}) {
    Program cut = program;
    cut.words.resize(keep);
    cut.doubles.resize(keep);
    refused(cut, 2, "box is cut off");
  }
}

TEST_CASE("an instruction finds what it needs on the stacks", "[program][verify]") {
  refused(program_of({kMin}), 0, "min needs 2 values, the stack holds 0");
  refused(program_of({kSphere, kMin}), 2, "min needs 2 values, the stack holds 1");
  refused(program_of({{Opcode::Negate}}), 0, "negate needs 1 values, the stack holds 0");
  refused(program_of({{Opcode::Tag, {}, 1}}), 0, "tag needs 1 values");
  refused(program_of({{Opcode::Tee, {}, 0}}, 1), 0, "tee needs 1 values");
  refused(program_of({kSphere, kDrop}), 2, "drop would take the caller's point");
}

TEST_CASE("a program ends with one value and the caller's point", "[program][verify]") {
  refused(program_of({}), 0, "ends with 0 values and 1 points");
  refused(program_of({kSphere, kSphere}), 4, "ends with 2 values and 1 points");
  refused(program_of({kMove, kSphere}), 6, "ends with 1 values and 2 points");
}

TEST_CASE("locals are declared and written before they are read", "[program][verify]") {
  refused(program_of({{Opcode::Load, {}, 0}}, 1), 0, "load 0: the local is read before it is written");
  refused(program_of({kSphere, {Opcode::Tee, {}, 0}, {Opcode::Load, {}, 1}, kMin}, 2), 3, "load 1");
  refused(program_of({kSphere, {Opcode::Tee, {}, 1}}, 1), 2, "tee 1: the program declares 1 locals");
  refused(program_of({kSphere, {Opcode::Load, {}, 2}, kMin}, 2), 2, "load 2: the program declares 2 locals");
  refused(program_of({kSphere, {Opcode::Tee, {}, vm::kMaxOperand}}, 1), 2, "the program declares 1 locals");
}

TEST_CASE("only some instructions have an operand", "[program][verify]") {
  Program program = program_of({kSphere});
  program.words[0] |= 4u << 8;
  refused(program, 0, "sphere has no operand 4");
  CHECK(passes(program_of({kSphere, {Opcode::Tag, {}, vm::kMaxOperand}})));
}

TEST_CASE("operands of shapes and functions are ones they have", "[program][verify]") {
  const auto modes = [](std::uint32_t operand) { return Instruction{Opcode::Sphere, {1, 2, 3, 0.5}, operand}; };
  CHECK(passes(program_of({modes(vm::kFusedTranslate)})));
  CHECK(passes(program_of({kSphere, modes(vm::kFusedTranslate | vm::kFusedMin)})));
  refused(program_of({modes(vm::kFusedTranslate | vm::kFusedMin)}), 0, "sphere needs 1 values, the stack holds 0");
  Program moved = program_of({modes(vm::kFusedTranslate)});
  moved.words[3] = std::bit_cast<std::uint32_t>(std::numeric_limits<float>::infinity());
  refused(moved, 0, "sphere: z is not finite");

  using vm::Source;
  const auto of = [](Opcode opcode, vm::Sources sources, std::vector<double> immediates = {}) {
    return Instruction{opcode, std::move(immediates), vm::operand_of(sources)};
  };
  CHECK(passes(program_of({of(Opcode::Add, {Source::X, Source::Constant}, {2})})));
  CHECK(passes(program_of({kSphere, of(Opcode::Add, {Source::Stack, Source::Z})})));
  CHECK(passes(program_of({of(Opcode::Sin, {Source::Y})})));
  refused(program_of({of(Opcode::Add, {Source::Stack, Source::Z})}), 0, "add needs 1 values");
  refused(program_of({of(Opcode::Sin, {Source::X, Source::Y})}), 0, "sin has no operand");
  refused(program_of({of(Opcode::Sin, {static_cast<Source>(6)})}), 0, "sin has no operand");
  refused(program_of({of(Opcode::Sin, {Source::X, Source::Stack, 1})}), 0, "sin has no operand");
  const Instruction tee{Opcode::Tee, {}, 0}, local = of(Opcode::Add, {Source::Stack, Source::Local, 0});
  CHECK(passes(program_of({kSphere, tee, local}, 1)));
  refused(program_of({kSphere, local, tee}, 1), 2, "add 0: the local is read before it is written");
  refused(program_of({kSphere, local}), 2, "the program declares 0 locals");
}

TEST_CASE("immediates are finite, in float and in double", "[program][verify]") {
  for (float bad : {std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity(),
                    std::numeric_limits<float>::quiet_NaN()}) {
    Program program = program_of({kMove, kSphere, kDrop});
    program.words[3] = std::bit_cast<std::uint32_t>(bad);
    refused(program, 0, "translate: z is not finite");
    program = program_of({kMove, kSphere, kDrop});
    program.doubles[5] = bad;
    refused(program, 4, "sphere: radius is not finite");
  }
  CHECK(passes(program_of({{Opcode::Sphere, {3.4e38}}})));
  refused(program_of({{Opcode::Sphere, {1e39}}}), 0, "sphere: radius is not finite");  // finite in double only
}

TEST_CASE("the wide table is as long as the code", "[program][verify]") {
  Program program = program_of({kSphere});
  program.doubles.pop_back();
  refused(program, 0, "wide");
  program.doubles.resize(3);
  refused(program, 0, "wide");
}

TEST_CASE("integer immediates are in the opcode's range", "[program][verify]") {
  const auto bulb = [](double power, double iterations) {
    std::vector<double> immediates(static_cast<std::size_t>(vm::info(Opcode::Mandelbulb).immediates), 1.0);
    immediates[0] = power, immediates[1] = iterations;
    return program_of({{Opcode::Mandelbulb, immediates}});
  };
  CHECK(passes(bulb(1, 1)));
  CHECK(passes(bulb(24, 256)));
  refused(bulb(0, 1), 0, "mandelbulb: power is 0, not in 1..24");
  refused(bulb(25, 1), 0, "mandelbulb: power is 25, not in 1..24");
  refused(bulb(2, 0), 0, "mandelbulb: iterations is 0, not in 1..256");
  refused(bulb(2, 257), 0, "mandelbulb: iterations is 257, not in 1..256");
  const vm::OpcodeInfo& row = vm::info(Opcode::Mandelbulb);
  CHECK(vm::largest_integer(row, 2) == 0);  // immediate 2 is the bailout, not an integer
  CHECK(vm::largest_integer(row, 99) == 0);
}

TEST_CASE("limits hold at their edge", "[program][verify]") {
  const Program two_words = program_of({kSphere});
  CHECK(passes(two_words, limits_with([](vm::Limits& l) { l.words = 2; })));
  refused(two_words, 0, "2 words; at most 1", limits_with([](vm::Limits& l) { l.words = 1; }));

  const Program three_locals = program_of({kSphere}, 3);
  CHECK(passes(three_locals, limits_with([](vm::Limits& l) { l.locals = 3; })));
  refused(three_locals, 0, "3 locals; at most 2", limits_with([](vm::Limits& l) { l.locals = 2; }));

  const Program three_values = program_of({kSphere, kSphere, kSphere, kMin, kMin});
  CHECK(passes(three_values, limits_with([](vm::Limits& l) { l.stack = 3; })));
  refused(three_values, 4, "a stack grows beyond 2", limits_with([](vm::Limits& l) { l.stack = 2; }));

  const Program three_points = program_of({kMove, kMove, kSphere, kDrop, kDrop});
  CHECK(passes(three_points, limits_with([](vm::Limits& l) { l.stack = 3; })));
  refused(three_points, 4, "a stack grows beyond 2", limits_with([](vm::Limits& l) { l.stack = 2; }));
}

TEST_CASE("random words are refused or run: nothing in between", "[program][verify]") {
  std::uint64_t state = 1;
  int passed = 0;
  for (int round = 0; round < 20000; ++round) {
    Program program;
    program.locals = 2;
    for (int i = 0; i < 6; ++i) {
      state = state * 6364136223846793005u + 1442695040888963407u;
      const auto opcode = static_cast<std::uint32_t>(state >> 33) % (vm::kOpcodeCount + 1);
      const std::uint32_t operand = static_cast<std::uint32_t>(state >> 60) < 4 ? (state >> 50) % 64 : 0u;
      const std::uint32_t word = opcode | operand << 8;
      program.words.push_back(word);
      const vm::OpcodeInfo* row = vm::find_opcode(opcode);
      for (int k = 0; row && k < vm::leading_immediates(word); ++k) program.words.push_back(0);
      for (int k = 0; row && k < row->immediates; ++k) {
        program.words.push_back(vm::is_integer_immediate(*row, k) ? 3 : 0);
      }
    }
    program.doubles.assign(program.words.size(), 0);
    const auto result = vm::verify(program);
    if (const auto* ok = std::get_if<vm::VerifiedProgram>(&result)) {
      ++passed;
      CHECK(ok->max_values() >= 1);
      CHECK(ok->max_points() >= 1);
    } else {
      const auto& error = std::get<vm::VerifyError>(result);
      CHECK(error.offset <= program.words.size());
      CHECK_FALSE(error.reason.empty());
    }
  }
  CHECK(passed > 10);
}

}  // namespace fathom::test::verify_test
