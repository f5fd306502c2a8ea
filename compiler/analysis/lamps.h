// Finds lamps (area lights): emissive shapes in the graph whose surface can be sampled.
//
// A lamp is a sphere, box, cylinder, capsule or quad with an emissive material. Only unions join a lamp to the scene,
// and transforms above a lamp only move, rotate and scale uniformly. An emissive shape that is cut, blended, bent or
// repeated is not a lamp: only rays that hit the shape find its light. A lamp that other objects hide in part stays a
// lamp, because shadow rays to the hidden part are blocked. A transparent shape is not a lamp: within a body of the
// same material, or of one that outranks it, the shape has no surface and blocks no rays.
//
// Tested by: tests/compiler/analysis/lamps_test.cpp
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "compiler/graph/graph.h"
#include "compiler/scene/compiled_scene.h"

namespace fathom::compiler {

// Maximum number of lamps. A DAG can stand for any number of lamps, and only the first ones are sampled.
inline constexpr std::size_t kMaxLamps = 65536;

// Returns the lamps in file order. Only the first of several lamps in the same place is listed.
std::vector<Lamp> find_lamps(const Scene& scene, std::span<const Surface> surfaces,
                             std::span<const Material> materials);

}  // namespace fathom::compiler
