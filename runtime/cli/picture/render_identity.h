// What makes two renders the same, sample by sample: the scene, its programs and every setting that changes bits, by
// name. Film files carry it, and a mismatch names what differs.
// Tested by: tests/runtime/cli/picture/cli_checkpoint_test.cpp
#pragma once

#include "compiler/scene/compiled_scene.h"
#include "runtime/film/film_file.h"
#include "runtime/path/options.h"

namespace fathom::cli {

// The version of what the renderer makes of a scene: films of another are of another render. Raised by whoever
// changes a bit of a picture; tests/runtime/renderer_bits_test.cpp fails until it is.
inline constexpr int kRendererBits = 8;

runtime::Identity render_identity(const compiler::CompiledScene& scene, const runtime::Settings& settings,
                                  const runtime::RenderOptions& options);

// The head of the render's film files.
runtime::FilmHeader film_header(const compiler::CompiledScene& scene, const runtime::Settings& settings,
                                const runtime::RenderOptions& options);

}  // namespace fathom::cli
