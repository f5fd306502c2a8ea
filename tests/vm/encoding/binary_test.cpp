// Programs as bytes: they read back bit for bit. If any byte is changed, the reader refuses the bytes or returns
// another valid program.
#include "vm/encoding/binary.h"

#include <cmath>
#include <variant>
#include <vector>

#include "tests/support/catch.h"
#include "tests/support/random/random_program.h"
#include "tests/support/same_program.h"
#include "tests/support/scaled_cases.h"
#include "vm/interpret/evaluate.h"

namespace fathom::test::binary_test {
namespace {

std::vector<std::uint8_t> bytes_of(const vm::VerifiedProgram& program) {
  vm::ByteWriter out;
  vm::write_program(out, program);
  return out.take();
}

std::string reason_of(const std::vector<std::uint8_t>& bytes) {
  vm::ByteReader in(bytes);
  const auto result = vm::read_program(in);
  const auto* error = std::get_if<vm::VerifyError>(&result);
  return error ? error->reason : "";
}

vm::VerifiedProgram program_of(Random& random, int seed) { return random_program(random, 1 + seed % 60); }

}  // namespace

TEST_CASE("random programs read back from their bytes", "[encoding][binary]") {
  const int count = scaled_cases(10000);
  for (int seed = 0; seed < count; ++seed) {
    Random random(static_cast<std::uint64_t>(seed));
    const vm::VerifiedProgram program = program_of(random, seed);
    vm::ByteWriter out;
    vm::write_program(out, program);
    vm::write_debug(out, program, program.program().source_name);
    vm::ByteReader in(out.bytes());
    auto read = vm::read_program(in);
    INFO("seed " << seed);
    REQUIRE(std::holds_alternative<vm::VerifiedProgram>(read));
    const auto& back = std::get<vm::VerifiedProgram>(read);
    const vm::DebugTable table = vm::read_debug(in, back);
    REQUIRE_FALSE(in.failed());
    REQUIRE(in.left() == 0);
    vm::Program whole = back.program();
    whole.source_name = table.source_name;
    whole.debug = table.entries;
    REQUIRE(same_program(whole, program.program()));
  }
}

TEST_CASE("of a program's bytes every cut is refused, and every changed byte is refused or another sound program",
          "[encoding][binary]") {
  vm::Workspace workspace;
  for (int seed = 0; seed < scaled_cases(40); ++seed) {
    Random random(static_cast<std::uint64_t>(seed));
    const std::vector<std::uint8_t> bytes = bytes_of(program_of(random, seed % 12));
    for (std::size_t size = 0; size < bytes.size(); ++size) {
      REQUIRE_FALSE(reason_of({bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size)}).empty());
    }
    for (std::size_t at = 0; at < bytes.size(); ++at) {
      std::vector<std::uint8_t> changed = bytes;
      changed[at] ^= static_cast<std::uint8_t>(1 + random.below(255));
      vm::ByteReader in(changed);
      const auto read = vm::read_program(in);
      if (const auto* program = std::get_if<vm::VerifiedProgram>(&read); program && in.left() == 0) {
        // An accepted program encodes to the same bytes, and the machine survives it.
        CHECK((bytes_of(*program) == changed));
        if (program->cost() < 100000) (void)vm::evaluate_distance(*program, glm::dvec3(0.1, 0.2, 0.3), workspace);
      }
    }
  }
}

TEST_CASE("what the bytes declare must be what the code is", "[encoding][binary]") {
  vm::Program program;
  program.append(vm::Opcode::Sphere, 0, {0.1}, {});
  const auto verified = vm::verify(program);
  const std::vector<std::uint8_t> bytes = bytes_of(std::get<vm::VerifiedProgram>(verified));
  // Layout: locals, values, points, words, 2 words, unrounded constants, {word, f64}.
  REQUIRE(bytes.size() == 16 + 8 + 4 + 12);
  const auto changed = [&](std::size_t at, std::uint8_t value) {
    std::vector<std::uint8_t> copy = bytes;
    copy[at] = value;
    return reason_of(copy);
  };
  CHECK(reason_of(bytes).empty());
  CHECK(changed(4, 2) == "declares stacks of 2 values and 1 points; the code reaches 1 and 1");
  CHECK(changed(8, 3) == "declares stacks of 1 values and 3 points; the code reaches 1 and 1");
  CHECK(changed(28, 2) == "the unrounded constants are not in order, or beyond the code");
  CHECK_THAT(changed(39, 0xff), Catch::Contains("not finite") || Catch::Contains("in the code"));
}

// Compiled files record the version of the machine that their programs are for. If this test fails, some opcode
// computes something else than before: increment kMachine in vm/encoding/binary.cpp, so that files of the old machine
// are refused, and put the new digest here.
TEST_CASE("the machine is the one whose number files carry", "[encoding][binary]") {
  vm::Workspace workspace;
  vm::ByteWriter values;
  for (std::uint32_t i = 0; i < vm::kOpcodeCount; ++i) {
    const vm::OpcodeInfo& row = *vm::find_opcode(i);
    if (row.form == vm::Form::Machine) continue;
    vm::Program program;
    std::vector<double> immediates;
    for (int n = 0; n < row.immediates; ++n) {
      immediates.push_back(vm::is_integer_immediate(row, n) ? 3 : 0.25 + 0.125 * n);
    }
    if (row.form == vm::Form::Outline) immediates = {0, 0, 1, 0, 0, 1};
    constexpr vm::Opcode kCoordinates[] = {vm::Opcode::X, vm::Opcode::Y, vm::Opcode::Z};
    for (int n = 0; n < row.effect.values_needed; ++n) program.append(kCoordinates[n], 0, {}, {});
    program.append(row.opcode, 0, immediates, {});
    if (row.form == vm::Form::Point) {
      program.append(vm::Opcode::Sphere, 0, {0.5}, {});
      program.append(vm::Opcode::Drop, 0, {}, {});
    }
    const auto verified = std::get<vm::VerifiedProgram>(vm::verify(program));
    for (const glm::dvec3 point : {glm::dvec3(0.3, 0.7, -0.2), glm::dvec3(-1.5, 0.4, 2.25), glm::dvec3(3, -2, 1)}) {
      const double value = vm::evaluate_distance(verified, point, workspace);
      values.f64(std::isnan(value) ? 0.5 : value);  // NaN has many bit patterns
    }
  }
  CHECK(vm::digest(values.bytes()).text() == "8096df856faa4c989fb82170d633ec46");
}

}  // namespace fathom::test::binary_test
