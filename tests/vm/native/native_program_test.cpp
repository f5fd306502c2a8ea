// Native code has the interpreter's bits, for every opcode and for random programs, and so have templates with a row
// of constants in every lane.
#include "vm/native/native_program.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <vector>

#include "tests/support/catch.h"
#include "tests/support/not_run.h"
#include "tests/support/plain_lowering.h"
#include "tests/support/random/random_program.h"
#include "tests/vm/number/float_bits.h"
#include "vm/encoding/disassemble.h"
#include "vm/interpret/evaluate.h"
#include "vm/prune/program_template.h"

namespace fathom::test::native_program_test {
namespace {

using vm::NativeIsa;
using vm::NativeProgram;
using vm::RecordedResults;

// Points of which every third has coordinates that break formulas.
Cloud nasty_cloud(std::size_t count, Random& random) {
  constexpr float kInf = std::numeric_limits<float>::infinity();
  constexpr float kNasty[] = {0.f,   -0.f,  1e-40f, -1e-45f, 1e-20f, 1e5f, -1e5f,
                              1e20f, 3e38f, -3e38f, kInf,    -kInf,  1.f,  std::numeric_limits<float>::quiet_NaN()};
  Cloud cloud;
  for (std::size_t i = 0; i < count; ++i) {
    const auto number = [&] {
      if (i % 3 == 0 && random.chance(0.5)) return kNasty[random.below(static_cast<int>(std::size(kNasty)))];
      return static_cast<float>(random.uniform(-3, 3));
    };
    const float x = number(), y = number(), z = number();
    cloud.add(x, y, z);
  }
  return cloud;
}

// Compares the program's template, with the program's constants in every lane, with the program itself.
void compare_rows(const vm::VerifiedProgram& program, const Cloud& cloud, const std::vector<float>& expected) {
  constexpr std::size_t kCount = 192;  // a whole number of registers
  const vm::ProgramTemplate code = vm::template_of(program);
  const std::vector<float> row = vm::constants_of(program);
  REQUIRE(row.size() == vm::constants_in(code));
  std::vector<float> constants(row.size() * vm::kRowStride), distance(kCount);
  for (std::size_t k = 0; k < row.size(); ++k) std::fill_n(&constants[k * vm::kRowStride], kCount, row[k]);
  const auto differences = [&] {
    int different = 0;
    for (std::size_t i = 0; i < kCount; ++i) different += bits_of(distance[i]) != bits_of(expected[i]);
    return different;
  };
  vm::Workspace workspace;
  vm::evaluate_rows(code, cloud.from(0), kCount, constants.data(), distance.data(), workspace);
  CHECK(differences() == 0);
  const auto native = NativeProgram::compile_rows(code);
  if (!native) return;
  native->evaluate_rows(cloud.from(0), kCount, constants.data(), distance.data());
  CHECK(differences() == 0);
}

// Compares the native code of a program with the interpreter. Returns false if the program has no native code.
bool compare(const vm::VerifiedProgram& program, NativeIsa isa, Random& random) {
  constexpr std::size_t kCount = 205;  // not a whole number of registers
  const Cloud cloud = nasty_cloud(kCount, random);
  vm::Workspace workspace;
  std::vector<float> distance(kCount), convex(kCount), expected(kCount), expected_convex(kCount);
  const auto differences = [&](const std::vector<float>& found, const std::vector<float>& truth) {
    int different = 0;
    for (std::size_t i = 0; i < kCount; ++i) different += bits_of(found[i]) != bits_of(truth[i]);
    return different;
  };
  const auto alone = NativeProgram::compile(program, RecordedResults::Distance, isa);
  const auto both = NativeProgram::compile(program, RecordedResults::DistanceAndConvexity, isa);
  if (!alone || !both) return false;
  vm::evaluate_convex(program, cloud.from(0), kCount, expected.data(), expected_convex.data(), workspace);
  INFO(vm::disassemble(program));
  alone->evaluate(cloud.from(0), kCount, distance.data());
  CHECK(differences(distance, expected) == 0);
  both->evaluate(cloud.from(0), kCount, distance.data(), convex.data());
  CHECK(differences(distance, expected) == 0);
  CHECK(differences(convex, expected_convex) == 0);
  if (isa == NativeProgram::available().front()) compare_rows(program, cloud, expected);

  const auto surface = NativeProgram::compile(program, RecordedResults::Surface, isa);
  if (!surface) return true;  // several times as long as the distance alone
  std::vector<float> x(kCount), y(kCount), z(kCount), expected_x(kCount), expected_y(kCount), expected_z(kCount);
  std::vector<std::uint32_t> id(kCount), expected_id(kCount);
  vm::evaluate_surface(program, cloud.from(0), kCount,
                       {expected.data(), expected_x.data(), expected_y.data(), expected_z.data(), expected_id.data(),
                        expected_convex.data()},
                       workspace);
  surface->evaluate_surface(cloud.from(0), kCount,
                            {distance.data(), x.data(), y.data(), z.data(), id.data(), convex.data()});
  CHECK(differences(distance, expected) == 0);
  CHECK(differences(x, expected_x) + differences(y, expected_y) + differences(z, expected_z) == 0);
  CHECK(differences(convex, expected_convex) == 0);
  CHECK(id == expected_id);
  return true;
}

}  // namespace

TEST_CASE("native code of every primitive has the interpreter's bits", "[native]") {
  if (NativeProgram::available().empty()) return not_run("this processor has no native code");
  for (const NativeIsa isa : NativeProgram::available()) {
    Random random(1);
    std::set<compiler::Kind> without;
    for (const compiler::Sort sort : {compiler::Sort::Solid, compiler::Sort::Outline}) {
      for (const compiler::Kind kind : primitive_kinds(sort, true)) {
        for (int i = 0; i < 4; ++i) {
          if (!compare(primitive_program(kind, random_params(kind, random)), isa, random)) without.insert(kind);
        }
      }
    }
    CHECK(without.size() <= 4);  // those that iterate
  }
}

TEST_CASE("native code of random programs has the interpreter's bits", "[native]") {
  if (NativeProgram::available().empty()) return not_run("this processor has no native code");
  for (const NativeIsa isa : NativeProgram::available()) {
    Random random(2);
    int compared = 0;
    for (int i = 0; i < 300; ++i) compared += compare(random_program(random, 1 + i / 2), isa, random);
    for (int i = 0; i < 100; ++i) compared += compare(plain_lowering(random_scene(random)), isa, random);
    CHECK(compared > 150);
  }
}

TEST_CASE("native code of an instruction set that has none does not exist", "[native]") {
  const IsaGuard guard;
  vm::force_isa("scalar");
  CHECK(NativeProgram::available().empty());
  vm::Program program;
  program.append(vm::Opcode::Sphere, 0, {1}, {});
  CHECK(NativeProgram::compile(verified(program), RecordedResults::Distance) == nullptr);
}

}  // namespace fathom::test::native_program_test
