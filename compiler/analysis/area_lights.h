// Finds area lights: emissive shapes in the graph whose surface can be sampled.
//
// An area light is a sphere, box, cylinder, capsule or quad with an emissive material. Only unions join an area light
// to the scene, and transforms above an area light only move, rotate and scale uniformly. An emissive shape that is
// cut, blended, bent or repeated is not an area light: only rays that hit the shape find its light. An area light
// that other objects hide in part stays an area light, because shadow rays to the hidden part are blocked. A
// transparent shape is not an area light: within a body of the same material, or of one that outranks it, the shape
// has no surface and blocks no rays.
//
// Tested by: tests/compiler/analysis/area_lights_test.cpp
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "compiler/graph/graph.h"
#include "compiler/scene/compiled_scene.h"

namespace fathom::compiler {

// Maximum number of area lights. A DAG can stand for any number of area lights, and only the first ones are sampled.
inline constexpr std::size_t kMaxAreaLights = 65536;

// Returns the area lights in file order. Only the first of several area lights in the same place is listed.
std::vector<AreaLight> find_area_lights(const Scene& scene, std::span<const Surface> surfaces,
                                        std::span<const Material> materials);

}  // namespace fathom::compiler
