// A scene as a shader and its values, for pages that draw it live (live_view.js, live.frag).
// Tested by: tests/runtime/live/live_page_test.cpp
#pragma once

#include <nlohmann/json.hpp>

#include "compiler/scene/compiled_scene.h"

namespace fathom::runtime {

// Returns an object: `shader` (GLSL without its version), camera, lights, surfaces, background, bound (null if it is
// endless), `slice` (the box that a slice shows, always finite). Places are scene coordinates; light is linear sRGB.
nlohmann::json live_scene(const compiler::CompiledScene& scene);

}  // namespace fathom::runtime
