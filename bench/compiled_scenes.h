// The benchmark scenes as C++ that is compiled into the program, with what the usual hand-written renderer makes of
// each (packets-inl.h).
#pragma once

#include <span>
#include <string_view>

#include "bench/workload.h"
#include "vm/interpret/evaluate.h"

namespace fathom::bench {

using vm::Points;

// distance[i] = f(points[i]). Reads points, and writes distances, past `count` up to a whole register.
using DistanceOf = void (*)(Points points, std::size_t count, float* distance);
using Render = void (*)(const View& view, const Frame& frame, Picture& picture);

struct CompiledAhead {
  const char* name;
  const char* path;  // of the scene file, from the root of the project, or of a large one where it was made
  View view;
  DistanceOf distance;
  Render shadow, paths;  // the workloads
};

// With the machine's own floating-point flags, for the instruction set that the machine uses.
std::span<const CompiledAhead> compiled_scenes();
// With -O3 -march=native -ffast-math.
std::span<const CompiledAhead> fast_scenes();

// Ends the program when there is none of that name.
const CompiledAhead& find(std::span<const CompiledAhead> scenes, std::string_view name);

}  // namespace fathom::bench
