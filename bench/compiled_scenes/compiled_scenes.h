// The benchmark scenes as C++ compiled into the program, each with the usual hand-written renderer around the scene
// (packets-inl.h).
#pragma once

#include <span>
#include <string_view>

#include "bench/workload.h"
#include "vm/interpret/evaluate.h"

namespace fathom::bench {

using vm::Points;

// distance[i] = f(points[i]). Reads points and writes distances past `count`, up to a whole register.
using DistanceOf = void (*)(Points points, std::size_t count, float* distance);
using Render = void (*)(const View& view, const Frame& frame, Picture& picture);

struct CompiledAhead {
  const char* name;
  const char* path;  // of the scene file, from the repository's root; for a large scene, of the generated file
  View view;
  DistanceOf distance;
  Render shadow, paths;  // workloads S and P (workload.h)
};

// Compiled with the machine's floating-point flags, for the instruction set that the machine uses.
std::span<const CompiledAhead> compiled_scenes();
// Compiled with -O3 -march=native -ffast-math.
std::span<const CompiledAhead> fast_scenes();

// Ends the program when no scene has that name.
const CompiledAhead& find(std::span<const CompiledAhead> scenes, std::string_view name);

}  // namespace fathom::bench
