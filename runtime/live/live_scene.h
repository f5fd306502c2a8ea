// A scene as a shader and its values, for pages that draw it live (live.js, live.frag).
// Tested by: tests/runtime/live/live_page_test.cpp
#pragma once

#include <nlohmann/json.hpp>

#include "compiler/scene/compiled_scene.h"

namespace fathom::runtime {

// Returns an object: `shader` (GLSL without its version), camera, lights, surfaces, background, bound. Places are scene
// coordinates; light is linear sRGB.
nlohmann::json live_scene(const compiler::CompiledScene& scene);

}  // namespace fathom::runtime
