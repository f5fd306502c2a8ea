// What an OpenEXR file says of its render: names of pbrt-v4 where it has one, `fathom.` before ours. docs/LAYERS.md
// lists them.
// Tested by: tests/runtime/cli_layers_test.cpp
#pragma once

#include <optional>

#include "compiler/compiled_scene.h"
#include "runtime/float_image.h"
#include "runtime/options.h"
#include "runtime/tone.h"

namespace fathom::cli {

// Without `seconds`, the time it took, they are the same for every run.
runtime::Attributes picture_attributes(const compiler::CompiledScene& scene, const runtime::Settings& settings,
                                       std::optional<double> seconds);

// The exposure and tone curve among them; those of a file that says nothing where they are missing.
runtime::ToneMapping tone_in(const runtime::Attributes& attributes);

}  // namespace fathom::cli
