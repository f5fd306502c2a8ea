// Fuzz target for listings of compiled scenes and of programs, as `fathom asm` reads them. The assembler refuses a
// listing with a message and its position, or returns a scene that writes as the same listing and can run.
#include "compiler/artefact/listing.h"
#include "compiler/compile.h"
#include "tests/fuzz/check_scene.h"
#include "tests/fuzz/seed_programs.h"
#include "tests/fuzz/target.h"
#include "vm/encoding/assemble.h"
#include "vm/encoding/disassemble.h"

namespace fathom::fuzz {

void run_assembly(Bytes input) {
  const std::string text = to_text(input);
  const auto assembled = vm::assemble(text);
  if (const auto* error = std::get_if<vm::AssembleError>(&assembled)) {
    promise(error->begin <= error->end && error->end <= text.size(), "an error is in the text");
    promise(!error->reason.empty(), "an error has a reason");
  }
  const compiler::Source source("listing.txt", text);
  compiler::Diagnostics diagnostics;
  compiler::FileContents contents;
  const auto scene = compiler::read_listing(source, diagnostics, contents);
  promise(scene.has_value() != diagnostics.has_errors(), "there is a scene exactly when there is no error");
  promise(scene || !diagnostics.print(source, compiler::ErrorFormat::Text).empty(), "every message is printed");
  if (!scene) return;
  const std::string written = compiler::write_listing(*scene, contents);
  compiler::FileContents again;
  const auto back = compiler::read_listing(compiler::Source("written.txt", written), diagnostics, again);
  promise(back.has_value(), "a written listing is read");
  promise(compiler::write_listing(*back, again) == written, "a written listing reads as another");
  promise(compiler::write_file(*back, again) == compiler::write_file(*scene, contents), "the file is the same");
  check_stored(*scene);
}

std::vector<Input> seeds_of_assembly() {
  std::vector<Input> seeds = golden_inputs("E07");
  for (const vm::VerifiedProgram& program : seed_programs()) seeds.push_back(to_input(vm::disassemble(program)));
  for (const compiler::CompiledScene& scene : seed_scenes()) {
    for (const bool all : {false, true}) seeds.push_back(to_input(compiler::write_listing(scene, {all, all, {}})));
  }
  seeds.push_back(
      to_input("locals 1\nsource \"scene.json\"\nsphere 0.5 at 0 1 0 @6:5 sphere \"ball\"\ntee 0\nmin _ %0\n"));
  return seeds;
}

}  // namespace fathom::fuzz
