// The answer about a pixel of the viewer: the object that its ray meets, the way there, and how the hit is known.
// Tested by: tests/runtime/cli/view/cli_view_test.cpp
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "compiler/scene/compiled_scene.h"

namespace fathom::cli {

// Returns the answer about the point (x, y) of a picture of that size, pixels. Places are in scene coordinates,
// lengths in scene units. `camera` is in the programs' coordinates.
nlohmann::json pixel_answer(const compiler::CompiledScene& scene, const compiler::Camera& camera, int width,
                            int height, double x, double y);

}  // namespace fathom::cli
