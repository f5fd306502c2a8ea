// Fuses adjacent instructions into one (vm/program/opcode.h, kFusedTranslate, kFusedMin, Source): a shape with the
// translate and the drop around it and the min after it, and a function with operands that are a coordinate, a
// constant or a local. The machine computes the same values, bit for bit, in fewer steps. Tested by:
// tests/compiler/lower/fuse_test.cpp
#pragma once

#include "vm/program/program.h"

namespace fathom::compiler {

// `program` keeps the verifier's rules and has debug entries, like a program of lower(). Fused instructions stay
// fused.
vm::Program fuse(vm::Program program);

}  // namespace fathom::compiler
