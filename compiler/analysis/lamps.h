// Glowing shapes that light can be sampled on, found in the graph.
//
// A lamp is a sphere, box, cylinder, capsule or quad with an emissive material that unions alone join to the scene
// and that transforms only move, turn and scale alike along all axes. What is cut, blended, bent or repeated is none:
// its light is found by rays that hit it. Where other objects hide part of a lamp it stays one: no ray arrives from
// there. What light may pass is none, either: within its like, or what outranks it, it has no surface and hides
// nothing.
//
// Tested by: tests/compiler/analysis/lamps_test.cpp
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "compiler/graph/graph.h"
#include "compiler/scene/compiled_scene.h"

namespace fathom::compiler {

// A DAG can stand for any number of lamps: the first so many are sampled.
inline constexpr std::size_t kMaxLamps = 65536;

// In the order of the file; of lamps in the same place the first.
std::vector<Lamp> find_lamps(const Scene& scene, std::span<const Surface> surfaces,
                             std::span<const Material> materials);

}  // namespace fathom::compiler
