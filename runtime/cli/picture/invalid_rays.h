// The warning of `fathom render` about rays that met a place where the field is NaN: their number, such a place, and
// the operation of the scene that causes the NaN.
// Tested by: tests/runtime/cli/picture/cli_invalid_test.cpp
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <string>

#include "compiler/scene/compiled_scene.h"

namespace fathom::cli {

// `at` is one of the places, in the programs' coordinates.
std::string invalid_text(const compiler::CompiledScene& scene, std::uint64_t invalid, std::uint64_t rays,
                         glm::dvec3 at);

}  // namespace fathom::cli
