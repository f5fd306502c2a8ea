// Two scenes as an engineer would write them by hand in C++ with SIMD: all constants in the code, one function, every
// primitive inlined. The bound an interpreter is measured against (bench/dispatch.cpp).
#pragma once

#include <cstddef>

#include "vm/evaluate.h"

namespace fathom::bench {

using Field = void (*)(vm::Points points, std::size_t count, float* distance);

// distance[i] = f(points[i]); `count` is a multiple of 16.
void primitives_by_hand(vm::Points points, std::size_t count, float* distance);  // scenes/bench/a-primitives.json
void csg_by_hand(vm::Points points, std::size_t count, float* distance);         // scenes/bench/b-csg.json

}  // namespace fathom::bench
