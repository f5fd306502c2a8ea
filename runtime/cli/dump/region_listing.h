// The output of fathom dump --region.
// Tested by: tests/runtime/cli/cli_dump_test.cpp
#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <string>

#include "compiler/scene/compiled_scene.h"

namespace fathom::cli {

// Returns a listing of the program part for the region around `point` (scene coordinates), and of the whole program.
// Returns nullopt if no regions can be built for the scene.
std::optional<std::string> region_listing(const compiler::CompiledScene& scene, glm::dvec3 point);

}  // namespace fathom::cli
