// The identity of a render: by name, the scene, its programs and every setting that changes bits of a sample. Film
// files store the identity, and a mismatch reports the rows that differ.
// Tested by: tests/runtime/cli/picture/cli_checkpoint_test.cpp
#pragma once

#include <optional>

#include "compiler/scene/compiled_scene.h"
#include "runtime/film/film_file.h"
#include "runtime/path/options.h"

namespace fathom::cli {

// Version of the renderer's output. Films of different versions belong to different renders. Raise the number with
// every change to the bits of an image: tests/runtime/renderer_bits_test.cpp fails until then.
inline constexpr int kRendererBits = 17;

// Row of the identity that has the number of a sequence's frame.
inline constexpr const char* kFrameRow = "frame";

runtime::Identity render_identity(const compiler::CompiledScene& scene, const runtime::Settings& settings,
                                  const runtime::RenderOptions& options);

// Returns the header of the render's film files. `frame` is the number of a sequence's frame.
runtime::FilmHeader film_header(const compiler::CompiledScene& scene, const runtime::Settings& settings,
                                const runtime::RenderOptions& options, std::optional<int> frame);

}  // namespace fathom::cli
