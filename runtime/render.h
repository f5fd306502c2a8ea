// The renderer's one function: CompiledScene -> film.
// Tested by: tests/runtime/render_test.cpp
#pragma once

#include "compiler/scene/compiled_scene.h"
#include "runtime/base/stats.h"
#include "runtime/field/regions.h"
#include "runtime/film/film.h"
#include "runtime/path/options.h"

namespace fathom::runtime {

// The film and the samples in it, with the settings and the counts.
struct RenderResult : PartialRender {
  Settings settings;  // resolved: the values that were used
  Stats stats;
};

// True if a render with these settings can resume from `render`. The check of identities (runtime/film/film_file.h)
// has refused films of other renders before, so a film for which this is false was forged.
bool can_resume(const PartialRender& render, const Settings& settings);

// Returns the options for building regions in a render with these settings. The options are equal for every part of
// an image and for any number of threads, because the cost layer depends on the regions.
RegionOptions region_options(const Settings& settings);

// Renders a scene. The film's bits depend only on the scene and on the settings except `threads` and `tile`.
RenderResult render(const compiler::CompiledScene& scene, const RenderOptions& options = {});

}  // namespace fathom::runtime
