// The attributes that an OpenEXR file stores about its render. Attributes of pbrt-v4 keep their names, and our own
// begin with `fathom.`. docs/reference/layers.md lists them.
// Tested by: tests/runtime/cli/picture/cli_layers_test.cpp
#pragma once

#include "compiler/scene/compiled_scene.h"
#include "runtime/film/partial_render.h"
#include "runtime/image/float_image.h"
#include "runtime/image/tone.h"
#include "runtime/path/options.h"

namespace fathom::cli {

// Returns attributes that are the same for every run and for every part of a render.
runtime::Attributes image_attributes(const compiler::CompiledScene& scene, const runtime::Settings& settings);

// Adds the average number of samples per pixel, and the ranges of samples that at least one pixel has: "0:16",
// "0:4,8:12". If samples were distributed adaptively, the range is that of the average pixel.
void describe_samples(const runtime::PartialRender& render, runtime::Attributes& attributes);

// Returns the exposure and tone curve from the attributes, or the defaults where these are missing.
runtime::ToneMapping tone_in(const runtime::Attributes& attributes);

}  // namespace fathom::cli
