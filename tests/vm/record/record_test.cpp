// Runs the recorded formulas, both as recorded and with their loop recovered, and compares the results with the
// machine's. tests/compiler/emit/emitted_cpp_test.cpp compiles the emitted source.
#include "vm/record/record.h"

#include <cmath>
#include <vector>

#include "tests/support/catch.h"
#include "tests/support/plain_lowering.h"
#include "tests/support/random/random_scene.h"
#include "tests/vm/number/float_bits.h"

namespace fathom::test::record_test {
namespace {

using vm::Opcode;
using vm::Operation;
using vm::RecordedFunction;
using vm::Ref;

float run_recorded(const RecordedFunction& function, const std::vector<float>& parameters);

// Executes one operation. Masks are 1 and 0.
float apply(Operation operation, float a, float b, float c) {
  switch (operation) {
    case Operation::Add:
      return a + b;
    case Operation::Subtract:
      return a - b;
    case Operation::Multiply:
      return a * b;
    case Operation::Divide:
      return a / b;
    case Operation::Negate:
      return -a;
    case Operation::Less:
      return a < b ? 1.f : 0.f;
    case Operation::Any:
      return a;
    case Operation::Select:
      return a != 0 ? b : c;
    case Operation::Min:
      return a < b ? a : b;
    case Operation::Max:
      return a > b ? a : b;
    case Operation::Abs:
      return std::fabs(a);
    case Operation::Sqrt:
      return std::sqrt(a);
    case Operation::IsNan:
      return std::isnan(a) ? 1.f : 0.f;
    case Operation::Mantissa:
    case Operation::Exponent: {
      int exponent;
      float mantissa = std::frexp(a, &exponent);  // in [1/2, 1)
      if (mantissa < 0.70710677f) mantissa *= 2, --exponent;
      return operation == Operation::Mantissa ? mantissa : static_cast<float>(exponent);
    }
    default:
      return run_recorded(vm::record(operation, false), {a, b, c});
  }
}

float run_recorded(const RecordedFunction& function, const std::vector<float>& parameters) {
  std::vector<float> values(function.statements.size()), carried;
  const auto value = [&](const Ref& ref) {
    if (ref.kind == Ref::Kind::Statement) return values[ref.index];
    if (ref.kind == Ref::Kind::Parameter) return parameters[ref.index];
    return ref.kind == Ref::Kind::Carried ? carried[ref.index] : static_cast<float>(ref.number);
  };
  // Runs statements [begin, end). Returns false if the test that ends the loop is 0.
  const auto run = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto& [operation, operands] = function.statements[i];
      values[i] = apply(operation, value(operands[0]), value(operands[1]), value(operands[2]));
      if (function.loop && operation == Operation::Any && values[i] == 0) return false;
    }
    return true;
  };
  if (!function.loop) {
    run(0, values.size());
    return value(function.results[0]);
  }
  const vm::Loop& loop = *function.loop;
  run(0, loop.begin);
  for (const auto& variable : loop.carried) carried.push_back(value(variable.initial));
  for (std::size_t pass = 0; pass < loop.count && run(loop.begin, loop.end); ++pass) {
    std::vector<float> next;
    for (const auto& variable : loop.carried) next.push_back(value(variable.next));
    carried = next;
  }
  run(loop.end, values.size());
  return value(function.results[0]);
}

// Compares both listings with the machine at some hundred points, near and far. The recovered loop must have `passes`
// passes.
void check_loop(Opcode opcode, const std::vector<double>& immediates, std::size_t passes) {
  vm::Program program;
  program.append(opcode, 0, immediates, {});
  const vm::VerifiedProgram machine = verified(program);
  const std::span<const std::uint32_t> words = std::span(program.words).subspan(1);
  const RecordedFunction plain = vm::record(opcode, words), rolled = vm::reroll(plain);
  CAPTURE(vm::info(opcode).mnemonic);
  REQUIRE_FALSE(plain.loop);
  REQUIRE(rolled.loop);
  CHECK(rolled.loop->count == passes);
  CHECK(rolled.statements.size() < plain.statements.size());
  Random random(17);
  vm::Workspace workspace;
  for (int i = 0; i < 300; ++i) {
    const glm::dvec3 place = random.in_box(i % 10 == 0 ? 100 : 1.5);
    std::vector<float> parameters;
    for (int axis = 0; axis < 3; ++axis) parameters.push_back(static_cast<float>(place[axis]));
    for (const double immediate : immediates) parameters.push_back(static_cast<float>(immediate));
    float expected;
    vm::evaluate_distance(machine, {&parameters[0], &parameters[1], &parameters[2]}, 1, &expected, workspace);
    CHECK(bits_of(run_recorded(plain, parameters)) == bits_of(expected));
    CHECK(bits_of(run_recorded(rolled, parameters)) == bits_of(expected));
  }
}

}  // namespace

TEST_CASE("the loops of recorded functions are found again", "[record][emit]") {
  check_loop(Opcode::Mandelbulb, {8, 9, 16, 1.104, 0.0005}, 9);
  check_loop(Opcode::Julia, {-0.2, 0.6, 0.1, 0.3, 11, 2.1, 40, 0.001}, 11);
  check_loop(Opcode::Ellipse, {1.25, 0.5, 1.3125, 0}, 24);
}

TEST_CASE("a recorded function of a single pass, or without a test, stays as it is", "[record][emit]") {
  vm::Program program;
  program.append(Opcode::Mandelbulb, 0, {8, 1, 16, 1.104, 0.0005}, {});
  CHECK_FALSE(vm::reroll(vm::record(Opcode::Mandelbulb, std::span(program.words).subspan(1))).loop);
  CHECK_FALSE(vm::reroll(vm::record(Opcode::Gyroid, {})).loop);
}

TEST_CASE("passes that differ are not taken for a loop", "[record][emit]") {
  // v = x; three passes: test v < 1; v = v + y. Later the last pass becomes v - y.
  const auto statement = [](std::uint32_t index) { return Ref{Ref::Kind::Statement, index}; };
  const Ref x{Ref::Kind::Parameter, 0}, y{Ref::Kind::Parameter, 1}, one{Ref::Kind::Number, 0, 1};
  RecordedFunction function;
  Ref v = x;
  for (std::uint32_t pass = 0; pass < 3; ++pass) {
    function.statements.push_back({Operation::Less, {v, one}});
    function.statements.push_back({Operation::Any, {statement(3 * pass)}});
    function.statements.push_back({Operation::Add, {v, y}});
    v = statement(3 * pass + 2);
  }
  function.results = {v};
  const RecordedFunction rolled = vm::reroll(function);
  REQUIRE(rolled.loop);
  CHECK(rolled.loop->carried.size() == 1);
  CHECK(run_recorded(rolled, {0.f, 0.25f}) == 0.75f);
  CHECK(run_recorded(rolled, {0.5f, 0.75f}) == 1.25f);  // ends after the first pass
  function.statements.back().operation = Operation::Subtract;
  CHECK_FALSE(vm::reroll(function).loop);
  // uses the result of the first pass instead of the second
  function.statements.back() = {Operation::Add, {v = statement(2), y}};
  CHECK_FALSE(vm::reroll(function).loop);
}

}  // namespace fathom::test::record_test
