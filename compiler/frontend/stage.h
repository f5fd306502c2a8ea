// Default staging of an imported model, whose file format describes only geometry: a ground plane under the model, a
// directional light with soft shadows, and a camera that frames the whole model. A drawing (seen from the front
// without perspective) needs no staging.
// Tested by: tests/compiler/frontend/stage_test.cpp, tests/runtime/cli/input/cli_import_test.cpp
#pragma once

#include "compiler/frontend/read_scene.h"
#include "compiler/scene/compiled_scene.h"

namespace fathom::compiler {

// True if the scene is an imported model, not a drawing.
bool wants_stage(const ReadScene& scene);

// Adds the ground and the light to the scene that a front end read, and removes its camera. `compiled` is the model
// alone: the ground goes below its lowest point. Does nothing if the model is unbounded or a drawing.
void set_stage(ReadScene& scene, const CompiledScene& compiled);

}  // namespace fathom::compiler
