// Programs as bytes: they read back bit for bit. If any byte is changed, the reader refuses the bytes or returns
// another valid program.
#include "vm/encoding/binary.h"

#include <cmath>
#include <string>
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
  vm::ProgramEncoder().write(out, program);
  return out.take();
}

std::string reason_of(const std::vector<std::uint8_t>& bytes) {
  vm::ByteReader in(bytes);
  const auto result = vm::ProgramDecoder().read(in);
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
    vm::ProgramEncoder().write(out, program);
    vm::write_debug(out, {program.program().source_name, program.program().debug});
    vm::ByteReader in(out.bytes());
    auto read = vm::ProgramDecoder().read(in);
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
      const auto read = vm::ProgramDecoder().read(in);
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
  // Layout: locals, values, points, words; a block of 1 instruction and 1 row: the opcode word, and a column of an
  // f64.
  REQUIRE(bytes.size() == 16 + 8 + 4 + 9);
  const auto changed = [&](std::size_t at, std::uint8_t value) {
    std::vector<std::uint8_t> copy = bytes;
    copy[at] = value;
    return reason_of(copy);
  };
  CHECK(reason_of(bytes).empty());
  CHECK(changed(4, 2) == "declares stacks of 2 values and 1 points; the code reaches 1 and 1");
  CHECK(changed(8, 3) == "declares stacks of 1 values and 3 points; the code reaches 1 and 1");
  CHECK(changed(16, 2) == "the program is cut off");
  CHECK(changed(20, 2) == "a block of instructions that makes no sense");
  CHECK(changed(20, 0) == "a block of instructions that makes no sense");  // a copy of an earlier program's
  CHECK(changed(28, 5) == "the program is cut off");
  std::vector<std::uint8_t> wide = bytes;  // 0.5 as f64 could be an f32
  wide[29 + 6] = 0xe0, wide[29 + 7] = 0x3f;
  std::fill_n(wide.begin() + 29, 6, std::uint8_t{0});
  CHECK(reason_of(wide) == "the program is not in the shortest form");
  CHECK_THAT(changed(36, 0xff), Catch::Contains("not finite") || Catch::Contains("in the code"));
}

// A union of a thousand balls is a body and three columns, and what an earlier program has, too, is its place there.
TEST_CASE("what repeats in programs is written once", "[encoding][binary]") {
  vm::Program program;
  for (int i = 0; i < 1000; ++i)
    program.append(vm::Opcode::Sphere, vm::kFusedTranslate | (i > 0 ? vm::kFusedMin : 0), {0.1 * i, 0.2 * i, 1, 0.5},
                   {0, 3, 7, "sphere"});
  for (std::size_t i = 0; i < program.debug.size(); ++i) program.debug[i].offset = static_cast<std::uint32_t>(5 * i);
  const auto balls = std::get<vm::VerifiedProgram>(vm::verify(program));
  program.append(vm::Opcode::Negate, 0, {}, {5000, 3, 7, "negate"});
  const auto inside_out = std::get<vm::VerifiedProgram>(vm::verify(program));
  vm::ByteWriter out;
  vm::ProgramEncoder encoder;
  encoder.write(out, balls);
  const std::size_t first = out.size();
  CHECK(first < 2 * 8 * 1000 + 200);
  encoder.write(out, inside_out);
  CHECK(out.size() - first < 100);
  vm::ByteReader in(out.bytes());
  vm::ProgramDecoder decoder;
  for (const vm::VerifiedProgram* each : {&balls, &inside_out}) {
    const auto back = decoder.read(in);
    REQUIRE(std::holds_alternative<vm::VerifiedProgram>(back));
    CHECK(std::get<vm::VerifiedProgram>(back).program().words == each->program().words);
    CHECK(std::get<vm::VerifiedProgram>(back).program().doubles == each->program().doubles);
  }
  vm::ByteWriter places;
  vm::write_debug(places, {"scene", program.debug});
  CHECK(places.size() < 100);
  vm::ByteReader read(places.bytes());
  CHECK(vm::read_debug(read, inside_out).entries.size() == 1001);
}

// A name of a megabyte in each of a thousand rows took a gigabyte.
TEST_CASE("a few bytes of debug entries make no large table", "[encoding][binary]") {
  vm::Program program;
  for (int i = 0; i < 1000; ++i) program.append(vm::Opcode::Sphere, i > 0 ? vm::kFusedMin : 0, {0.5}, {});
  const auto balls = std::get<vm::VerifiedProgram>(vm::verify(program));
  const auto reads = [&](std::size_t letters) {
    vm::ByteWriter out;
    out.text("scene");
    out.u32(1), out.u32(3), out.u32(7), out.text(std::string(letters, 'n'));
    out.u32(1), out.u32(1), out.u32(1000), out.u32(0);  // a block of one entry and a thousand rows
    vm::ByteReader in(out.bytes());
    return vm::read_debug(in, balls).entries.size() == 1000 && !in.failed();
  };
  CHECK(reads(1000));
  CHECK_FALSE(reads(1'000'000));
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
