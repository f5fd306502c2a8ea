// A page that draws a scene live: one HTML text that needs no network, for any browser with WebGL2.
//
// The page evaluates the scene's own distance function (compiler/emit/emit.h) at every pixel, and moves the camera by
// mouse, finger and keys. Its light is a preview: lights with soft shadows, area lights as points, the background as
// light from around, openness in place of bounces. Textures and glass have one colour.
// Tested by: tests/runtime/live/live_page_test.cpp
#pragma once

#include <string>

#include "compiler/scene/compiled_scene.h"

namespace fathom::runtime {

std::string live_page(const compiler::CompiledScene& scene);

}  // namespace fathom::runtime
