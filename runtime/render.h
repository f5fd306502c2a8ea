// The renderer's one function: CompiledScene -> picture.
// Tested by: tests/runtime/render_test.cpp
#pragma once

#include "compiler/scene/compiled_scene.h"
#include "runtime/base/stats.h"
#include "runtime/field/regions.h"
#include "runtime/film/film.h"
#include "runtime/path/options.h"

namespace fathom::runtime {

// The film, and what of the work is in it.
struct RenderResult : PartialRender {
  Settings settings;  // those used
  Stats stats;
};

// Whether a render with these settings can go on from `render`: films of others are refused before by their identity
// (runtime/film/film_file.h), so a file that says no was made up.
bool can_resume(const PartialRender& render, const Settings& settings);

// How a render with these settings builds regions: the same for every part of a picture and for any number of
// threads, for the layer of costs depends on it.
RegionOptions region_options(const Settings& settings);

// The film's bits depend on the scene and on the settings but for `threads` and `tile`.
RenderResult render(const compiler::CompiledScene& scene, const RenderOptions& options = {});

}  // namespace fathom::runtime
