// What an OpenEXR file says of its render: names of pbrt-v4 where it has one, `fathom.` before ours. docs/LAYERS.md
// lists them.
// Tested by: tests/runtime/cli/picture/cli_layers_test.cpp
#pragma once

#include "compiler/scene/compiled_scene.h"
#include "runtime/film/partial_render.h"
#include "runtime/image/float_image.h"
#include "runtime/image/tone.h"
#include "runtime/path/options.h"

namespace fathom::cli {

// The same for every run, and for every part of a render.
runtime::Attributes picture_attributes(const compiler::CompiledScene& scene, const runtime::Settings& settings);

// Adds how many samples a pixel has on average, and which of them some pixel has: "0:16", "0:4,8:12". Of a render
// whose samples were shared out the numbers of the average pixel's.
void describe_samples(const runtime::PartialRender& render, runtime::Attributes& attributes);

// The exposure and tone curve among them; those of a file that says nothing where they are missing.
runtime::ToneMapping tone_in(const runtime::Attributes& attributes);

}  // namespace fathom::cli
