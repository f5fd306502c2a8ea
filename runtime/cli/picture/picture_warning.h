// What is said of a picture that shows nothing: no solid in view, black throughout, one color throughout.
// Tested by: tests/runtime/cli/picture/cli_picture_warning_test.cpp
#pragma once

#include <optional>
#include <string>

#include "compiler/scene/compiled_scene.h"
#include "compiler/source/diagnostics.h"
#include "runtime/render.h"

namespace fathom::cli {

// W0516, where the box of the whole scene proves that no camera ray meets it.
void warn_of_empty_view(const compiler::CompiledScene& scene, compiler::Diagnostics& diagnostics);

// Of a picture that is complete; nullopt when it shows something, and for a single pixel.
std::optional<std::string> picture_warning(const compiler::CompiledScene& scene, const runtime::RenderResult& result);

}  // namespace fathom::cli
