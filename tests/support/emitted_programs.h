// Programs for the tests of `fathom emit`: every opcode alone, all that operands can say, random scenes. A program of
// the build (tests/emit_programs.cpp) emits them and the tests are compiled with what it writes, so both draw the
// same.
#pragma once

#include <string>
#include <vector>

#include "compiler/scene/compiled_scene.h"

namespace fathom::test {

struct EmittedProgram {
  std::string name;               // an identifier, in C++ and in GLSL
  compiler::CompiledScene scene;  // of its fields those that are emitted; the rest is empty
};

std::vector<EmittedProgram> emitted_programs();

}  // namespace fathom::test
