// x86 machine code of an operation graph, for AVX2 or AVX-512.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "vm/native/native_isa.h"
#include "vm/native/operation_graph.h"

namespace fathom::vm {

// Arguments of the code: evaluates `registers` registers of points. All arrays are read and written in whole
// registers.
struct NativeArguments {
  const float* inputs[3];
  const float* constants;
  std::size_t bytes;  // of one array
  float* results[6];
  const float* row;  // [constant][lane], rows kRowStride apart (vm/prune/program_template.h)
};
using NativeFunction = void (*)(const NativeArguments*);

struct NativeCode {
  std::vector<std::uint8_t> bytes;  // position-independent
  std::vector<float> constants;
};

// Returns no bytes if the assembler fails or the code needs a large stack frame.
NativeCode emit_x86(const OperationGraph& graph, NativeIsa isa);

}  // namespace fathom::vm
