// Fuses instructions that come together into one (vm/program/opcode.h, kMoved, kJoined, Source): a shape with the translate
// and the drop around it and the min after it; a function with operands that are a coordinate, a constant or a local.
// The values are the same, bit for bit, with fewer steps of the machine. Tested by: tests/compiler/lower/fuse_test.cpp
#pragma once

#include "vm/program/program.h"

namespace fathom::compiler {

// `program` keeps the verifier's rules and has its debug entries, as that of lower() does. What is fused already
// stays.
vm::Program fuse(vm::Program program);

}  // namespace fathom::compiler
