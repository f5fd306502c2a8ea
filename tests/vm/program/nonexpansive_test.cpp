// Checks the opcodes without Fact::Expansive: their result never changes faster than their point moves.
#include <set>

#include "tests/support/scaled_cases.h"
#include "tests/vm/range/boxes.h"
#include "vm/program/opcode_rows.h"

namespace fathom::test::nonexpansive_test {
namespace {

using vm::Opcode;

// One instruction of a random program, as a program of its own.
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
    if (vm::has(info.opcode, vm::Fact::Expansive)) continue;
    Row row;
    const auto begin = static_cast<std::ptrdiff_t>(at);
    const auto end = begin + static_cast<std::ptrdiff_t>(vm::instruction_length(from.words[at]));
    row.code.words.assign(from.words.begin() + begin, from.words.begin() + end);
    row.code.doubles.assign(from.doubles.begin() + begin, from.doubles.begin() + end);
    row.name = std::string(info.mnemonic);
    for (std::size_t i = 1; i < row.code.doubles.size(); ++i) row.name += " " + std::to_string(row.code.doubles[i]);
    rows.push_back(std::move(row));
  }
  return rows;
}

// Value of the row at p, or the point that the row maps p to.
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

}  // namespace

TEST_CASE("rows said to be nonexpansive are, wherever two points lie", "[program][enclosure]") {
  vm::Workspace workspace;
  std::set<Opcode> seen;
  int violations = 0;
  for (std::uint64_t seed = 0; seed < 1500 && violations < 10; ++seed) {
    if (seed % 3 == 1) continue;  // formulas
    Random random(seed);
    const BoxSample sampled = sample(seed, random);
    for (const vm::Form form : {vm::Form::Shape, vm::Form::Point}) {
      for (const Row& row : rows_of(sampled.program, form)) {
        seen.insert(static_cast<Opcode>(row.code.words[0] & 0xff));
        const auto parts = parts_of(row, form);
        for (int i = 0; i < scaled_cases(40); ++i) {
          const double far = random.chance(0.2) ? random.length(1, 1e3) : 1;
          const glm::dvec3 p = random.in_box(3) * far, q = p + random.direction() * random.length(1e-5, 10) * far;
          const glm::dvec3 from = image_of(parts, p, workspace), to = image_of(parts, q, workspace);
          const double apart = glm::distance(p, q), moved = glm::distance(from, to);
          const double rounding = 1e-11 * far + 1e-15 * (glm::length(from) + glm::length(to));
          if (moved <= apart * (1 + 1e-9) + rounding) continue;
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
    if (claimed && !vm::has(info.opcode, vm::Fact::Expansive)) CHECK(seen.count(info.opcode) == 1);
  }
}

}  // namespace fathom::test::nonexpansive_test
