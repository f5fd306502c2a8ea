// What fathom dump --region prints. Tested by: tests/runtime/cli/cli_dump_test.cpp
#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <string>

#include "compiler/scene/compiled_scene.h"

namespace fathom::cli {

// The part of the scene's program that matters in the region at `point` (scene coordinates), and the whole program;
// nothing when the scene's program cannot be cut.
std::optional<std::string> region_listing(const compiler::CompiledScene& scene, glm::dvec3 point);

}  // namespace fathom::cli
