// Programs of random graphs, for the seeds of what reads programs.
#pragma once

#include <vector>

#include "compiler/fuse.h"
#include "tests/support/plain_lowering.h"
#include "tests/support/random_scene.h"

namespace fathom::fuzz {

// A dozen, of a few to some dozens of instructions, fused and not.
inline std::vector<vm::VerifiedProgram> seed_programs() {
  std::vector<vm::VerifiedProgram> programs;
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    test::Random random(seed);
    test::GraphOptions options;
    options.depth = 1 + static_cast<int>(seed % 3);
    vm::VerifiedProgram program = test::plain_lowering(test::random_scene(random, options));
    programs.push_back(seed % 2 ? test::verified(compiler::fuse(program.program())) : std::move(program));
  }
  return programs;
}

}  // namespace fathom::fuzz
