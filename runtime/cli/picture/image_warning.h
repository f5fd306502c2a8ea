// Warnings about an image that shows nothing: no solid in view, black throughout, or one color throughout.
// Tested by: tests/runtime/cli/picture/cli_picture_warning_test.cpp
#pragma once

#include <optional>
#include <string>

#include "compiler/scene/compiled_scene.h"
#include "compiler/source/diagnostics.h"
#include "runtime/render.h"

namespace fathom::cli {

// Adds the warning W0516 if the scene's bounding box proves that no camera ray can hit the scene.
void warn_of_empty_view(const compiler::CompiledScene& scene, compiler::Diagnostics& diagnostics);

// Returns the warning for a complete image. Returns nullopt if the image shows something or has a single pixel.
std::optional<std::string> image_warning(const compiler::CompiledScene& scene, const runtime::RenderResult& result);

}  // namespace fathom::cli
