// A scene as a shader and its values, for pages that draw it live (live_view.js, live.frag).
// Tested by: tests/runtime/live/live_page_test.cpp
#pragma once

#include <nlohmann/json.hpp>

#include "compiler/scene/compiled_scene.h"

namespace fathom::runtime {

// Returns an object: `shader` (GLSL without its version) and `numbers` (the bits of its uniform block's floats),
// camera, lights, surfaces, background, `box` (around the scene), `slice` (the box across which slices are chosen)
// and `sliceBox` (in which they are shown), all finite. Scenes that differ only in numbers have the same shader.
// Places are scene coordinates; light is linear sRGB.
nlohmann::json live_scene(const compiler::CompiledScene& scene);

// Returns the exactness of the surfaces' fields, 2 bits each, 16 in a number, the first ones lowest: exact, bound,
// estimate. Takes about as long as compiling the scene.
nlohmann::json live_exactness(const compiler::CompiledScene& scene);

}  // namespace fathom::runtime
