// Fuzz target for programs and compiled files. An input that begins like a compiled file is one. Otherwise the first
// byte decides. If the byte is even, one program follows in the layout of vm/encoding/binary.h. If the byte is odd,
// sections of a compiled file follow: u32 size of the code, u32 size of the tables, u32 size of the debug section,
// then these sections and the text. The target adds the correct digests, because a fuzz run would never find them.
// The reader refuses an input with a reason, or the result writes as the same bytes and can run.
#include <algorithm>

#include "compiler/artefact/compiled_file.h"
#include "compiler/compile.h"
#include "tests/fuzz/check_program.h"
#include "tests/fuzz/check_scene.h"
#include "tests/fuzz/seed_programs.h"
#include "tests/fuzz/target.h"
#include "tests/support/sealed_file.h"
#include "vm/encoding/binary.h"

namespace fathom::fuzz {
namespace {

Input sealed_input(Bytes input) {
  vm::ByteReader in(input);
  std::size_t sizes[3];
  for (std::size_t& size : sizes) size = in.u32();
  test::Sections sections;
  Input* const parts[] = {&sections.code, &sections.tables, &sections.debug};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto part = in.raw(std::min(sizes[i], in.left()));
    parts[i]->assign(part.begin(), part.end());
  }
  const auto text = in.raw(in.left());
  sections.text.assign(text.begin(), text.end());
  return test::sealed(sections);
}

Input sections_of_seed(const Input& file) {
  const test::Sections sections = test::sections_of(file);
  vm::ByteWriter out;
  out.u8(1);
  for (const Input* part : {&sections.code, &sections.tables, &sections.debug}) {
    out.u32(static_cast<std::uint32_t>(part->size()));
  }
  for (const Input* part : {&sections.code, &sections.tables, &sections.debug, &sections.text}) out.raw(*part);
  return out.take();
}

void run_bare_program(Bytes input) {
  vm::ByteReader reader(input);
  vm::Limits machine = compiler::largest_machine();
  machine.words = 1 << 20;  // rows ask for any number in a few bytes
  const auto read = vm::ProgramDecoder().read(reader, machine);
  const auto* program = std::get_if<vm::VerifiedProgram>(&read);
  if (program == nullptr) return promise(!std::get<vm::VerifyError>(read).reason.empty(), "there is a reason");
  vm::ByteWriter writer;
  vm::ProgramEncoder().write(writer, *program);
  const auto size = static_cast<std::ptrdiff_t>(reader.offset());
  promise(writer.bytes() == Input(input.begin(), input.begin() + size), "what is written is what was read");
  test::Random random(input.size());
  if (program->cost() <= kMaxCost) check_evaluation(*program, random);
}

}  // namespace

void run_program(Bytes input) {
  if (input.empty()) return;
  const bool whole = compiler::is_compiled_file(to_text(input));
  if (!whole && input[0] % 2 == 0) return run_bare_program(input.subspan(1));
  const Input file = whole ? Input(input.begin(), input.end()) : sealed_input(input.subspan(1));
  const auto stored = compiler::read_stored(file, "scene.fbc");
  const auto* good = std::get_if<compiler::StoredScene>(&stored);
  if (good == nullptr) {
    promise(!std::get<compiler::FileError>(stored).reason.empty(), "a refusal has a reason");
    return;
  }
  promise(compiler::write_file(good->scene, good->contents) == file, "what is accepted is written as itself");
  check_stored(good->scene);
}

std::vector<Input> seeds_of_program() {
  std::vector<Input> seeds;
  for (const vm::VerifiedProgram& program : seed_programs()) {
    vm::ByteWriter out;
    out.u8(0);
    vm::ProgramEncoder().write(out, program);
    seeds.push_back(out.take());
  }
  for (const compiler::CompiledScene& scene : seed_scenes()) {
    for (const bool all : {false, true}) {
      seeds.push_back(compiler::write_file(scene, {all, all, {}}));
      seeds.push_back(sections_of_seed(seeds.back()));
    }
  }
  return seeds;
}

}  // namespace fathom::fuzz
