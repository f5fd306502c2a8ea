// Scenes as `fathom emit cpp` writes them, compiled ahead of time with the machine's lanes and floating-point flags:
// what the machine would be without interpretation. Same bits as the machine.
#pragma once

#include "bench/hand_written.h"

namespace fathom::bench {

// distance[i] = f(points[i]); `count` is a multiple of 16.
void primitives_emitted(vm::Points points, std::size_t count, float* distance);  // scenes/bench/a-primitives.json
void csg_emitted(vm::Points points, std::size_t count, float* distance);         // scenes/bench/b-csg.json
void mandelbulb_emitted(vm::Points points, std::size_t count, float* distance);  // scenes/bench/c-mandelbulb.json
void gyroid_emitted(vm::Points points, std::size_t count, float* distance);      // scenes/bench/e-gyroid.json
void thousand_emitted(vm::Points points, std::size_t count, float* distance);    // scenes/bench/d1000.json

}  // namespace fathom::bench
