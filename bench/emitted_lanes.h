// vm::Batch as the lane type of emitted C++ (the contract is at the head of every emitted header). Batch lacks only
// the two halves of split_power_of_two as separate functions. Compiled once per instruction set, like the file that
// includes this header:
//
//     HWY_BEFORE_NAMESPACE();
//     namespace fathom::bench::HWY_NAMESPACE {
//     #undef SCENE_A_DISTANCE_H
//     #include "scene_a.h"              // fathom emit cpp ... --namespace scene_a
//     scene_a::distance(x, y, z)        // of three Batches
//
// The headers that scene_a.h includes must be included before. Tested by: tests/compiler/emit/emitted_lanes_test.cpp
#if defined(FATHOM_BENCH_EMITTED_LANES) == defined(HWY_TARGET_TOGGLE)
#ifdef FATHOM_BENCH_EMITTED_LANES
#undef FATHOM_BENCH_EMITTED_LANES
#else
#define FATHOM_BENCH_EMITTED_LANES
#endif

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include "vm/number/batch-inl.h"

HWY_BEFORE_NAMESPACE();
namespace fathom::vm::HWY_NAMESPACE {

HWY_INLINE Batch mantissa(Batch x) { return split_power_of_two(x).mantissa; }
HWY_INLINE Batch exponent(Batch x) { return split_power_of_two(x).exponent; }

}  // namespace fathom::vm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
