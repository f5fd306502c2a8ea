// Compiled with -O3 -march=native -ffast-math (bench/CMakeLists.txt). What has a name in the machine is given another
// here, so that the linker does not take one for the other.
#include "bench/compiled_scenes.h"

#define HWY_COMPILE_ONLY_STATIC
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL)  // the same registers as the machine
#include "hwy/highway.h"
#define vm vm_fast
#include "bench/compiled_scenes-inl.h"

namespace fathom::bench {

std::span<const CompiledAhead> fast_scenes() { return HWY_NAMESPACE::scene_table(); }

}  // namespace fathom::bench
