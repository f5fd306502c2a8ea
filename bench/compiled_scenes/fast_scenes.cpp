// Compiled with -O3 -march=native -ffast-math (bench/CMakeLists.txt). The macro renames namespace vm, so that the
// linker does not confuse these functions with the machine's.
#include "bench/compiled_scenes/compiled_scenes.h"

#define HWY_COMPILE_ONLY_STATIC
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL)  // the machine's register widths
#include "hwy/highway.h"
#define vm vm_fast
#include "bench/compiled_scenes/compiled_scenes-inl.h"

namespace fathom::bench {

std::span<const CompiledAhead> fast_scenes() { return HWY_NAMESPACE::scene_table(); }

}  // namespace fathom::bench
