// Bytes as programs. After an even first byte: one program as vm/binary.h lays it out; what is read is verified, is
// written as the same bytes, and keeps all promises of programs. After an odd one: a compiled file (.fbc), refused
// with a reason or a scene whose programs do.
#include <utility>

#include "compiler/artefact/load.h"
#include "compiler/compile.h"
#include "tests/fuzz/check_program.h"
#include "tests/fuzz/seed_programs.h"
#include "tests/fuzz/target.h"
#include "vm/binary.h"

namespace fathom::fuzz {
namespace {

void check_cheap(const vm::VerifiedProgram& program, std::size_t seed) {
  test::Random random(seed);
  if (program.cost() <= kMostCost) check_program(program, random);
}

void run_bare_program(Bytes input) {
  vm::ByteReader reader(input);
  const auto read = vm::read_program(reader);
  const auto* program = std::get_if<vm::VerifiedProgram>(&read);
  if (program == nullptr) return promise(!std::get<vm::VerifyError>(read).reason.empty(), "there is a reason");
  vm::ByteWriter writer;
  vm::write_program(writer, *program);
  const std::vector<std::uint8_t> written = std::move(writer).take();
  vm::ByteReader again(written);
  const auto same = vm::read_program(again);
  const auto* back = std::get_if<vm::VerifiedProgram>(&same);
  promise(back != nullptr && back->program().words == program->program().words, "what is written is what is read");
  check_cheap(*program, input.size());
}

void run_compiled_file(Bytes input) {
  const auto read = compiler::read_stored(input, "fuzz");
  const auto* stored = std::get_if<compiler::StoredScene>(&read);
  if (stored == nullptr) return promise(!std::get<compiler::FileError>(read).reason.empty(), "there is a reason");
  check_cheap(stored->scene.distance, input.size());
  check_cheap(stored->scene.surface, input.size());
}

constexpr const char* kScene = R"({"version": 1, "materials": {"m": {"type": "diffuse"}, "n": {"type": "specular"}},
  "objects": [{"type": "sphere", "radius": 1, "material": "m"},
    {"type": "box", "half_size": [1, 2, 1], "translate": [4, 0, 0], "material": "n"}]})";

}  // namespace

void run_program(Bytes input) {
  if (input.empty()) return;
  if (input[0] % 2 == 0) return run_bare_program(input.subspan(1));
  run_compiled_file(input.subspan(1));
}

std::vector<Input> seeds_of_program() {
  std::vector<Input> seeds;
  for (const vm::VerifiedProgram& program : seed_programs()) {
    vm::ByteWriter writer;
    vm::write_program(writer, program);
    Input seed = std::move(writer).take();
    seed.insert(seed.begin(), 0);
    seeds.push_back(std::move(seed));
  }
  compiler::Diagnostics diagnostics;
  if (const auto scene = compiler::compile({"scene.json", kScene}, diagnostics)) {
    Input seed = compiler::write_file(*scene);
    seed.insert(seed.begin(), 1);
    seeds.push_back(std::move(seed));
  }
  return seeds;
}

}  // namespace fathom::fuzz
