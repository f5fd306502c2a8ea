// Listings: what the assembler takes is verified or refused; a program that is sound reads as itself from its own
// listing, and keeps all promises of programs.
#include <utility>

#include "tests/fuzz/check_program.h"
#include "tests/fuzz/seed_programs.h"
#include "tests/fuzz/target.h"
#include "vm/assemble.h"
#include "vm/disassemble.h"

namespace fathom::fuzz {

void run_assembly(Bytes input) {
  const std::string text = to_text(input);
  auto assembled = vm::assemble(text);
  if (const auto* error = std::get_if<vm::AssembleError>(&assembled)) {
    promise(error->begin <= error->end && error->end <= text.size(), "an error is in the text");
    promise(!error->reason.empty(), "an error has a reason");
    return;
  }
  const auto verified = vm::verify(std::get<vm::Program>(std::move(assembled)));
  const auto* program = std::get_if<vm::VerifiedProgram>(&verified);
  if (program == nullptr) return;
  const auto again = vm::assemble(vm::disassemble(*program));
  const auto* same = std::get_if<vm::Program>(&again);
  promise(same != nullptr && same->words == program->program().words && same->wide == program->program().wide,
          "a listing reads as its program");
  test::Random random(text.size());
  if (program->cost() <= kMostCost) check_program(*program, random);
}

std::vector<Input> seeds_of_assembly() {
  std::vector<Input> seeds;
  for (const vm::VerifiedProgram& program : seed_programs()) seeds.push_back(to_input(vm::disassemble(program)));
  seeds.push_back(
      to_input("locals 1\nsource \"scene.json\"\nsphere 0.5 at 0 1 0 @6:5 sphere \"ball\"\ntee 0\nmin _ %0\n"));
  return seeds;
}

}  // namespace fathom::fuzz
