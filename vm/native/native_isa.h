// Instruction sets that have native code.
#pragma once

namespace fathom::vm {

enum class NativeIsa { Avx2, Avx512 };

}  // namespace fathom::vm
