#include "runtime/cli/dump/program_diff.h"

#include <fmt/format.h>

#include "compiler/source/line_diff.h"
#include "vm/encoding/disassemble.h"

namespace fathom::cli {
namespace {

std::string instructions_of(const vm::Program& program) {
  std::string text;
  for (std::size_t at = 0; at < program.words.size(); at += vm::instruction_length(program.words[at])) {
    text += vm::instruction_text(program, at) + "\n";
  }
  return text;
}

}  // namespace

std::string program_diff(const DiffSide& before, const DiffSide& after) {
  const vm::VerifiedProgram &a = before.program, &b = after.program;
  const std::string diff = compiler::unified_diff(instructions_of(a.program()), instructions_of(b.program()));
  if (diff.empty()) return fmt::format("; {} and {} are the same program\n", before.name, after.name);
  return fmt::format("; {} -> {} ops, {} -> {} words, cost {} -> {}\n--- {}\n+++ {}\n{}", a.instructions(),
                     b.instructions(), a.program().words.size(), b.program().words.size(), a.cost(), b.cost(),
                     before.name, after.name, diff);
}

}  // namespace fathom::cli
