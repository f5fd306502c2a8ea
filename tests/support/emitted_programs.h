// Programs for the tests of `fathom emit`: every opcode alone, every operand, random scenes. The build runs a program
// (tests/emit_programs.cpp) that emits them and compiles its output into the tests, so both use the same list.
#pragma once

#include <string>
#include <vector>

#include "compiler/scene/compiled_scene.h"

namespace fathom::test {

struct EmittedProgram {
  std::string name;               // an identifier in C++ and in GLSL
  compiler::CompiledScene scene;  // only the fields that the emitter reads; all others are empty
};

std::vector<EmittedProgram> emitted_programs();

}  // namespace fathom::test
