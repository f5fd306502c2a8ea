// What a model from elsewhere is looked at with, since its format has none of it: a ground that it stands on, a lamp
// with soft shadows, and a camera that has all of it in the picture. A drawing, which is seen from the front without
// perspective, needs nothing. Tested by: tests/compiler/frontend/stage_test.cpp, tests/runtime/cli/input/cli_import_test.cpp
#pragma once

#include "compiler/frontend/read_scene.h"
#include "compiler/scene/compiled_scene.h"

namespace fathom::compiler {

// Whether it is a model from elsewhere, and no drawing.
bool wants_stage(const ReadScene& scene);

// Adds the ground, below `compiled`, which is the model alone, and the lamp to what a front end made of it, and takes
// its camera out. Nothing where the model has no end or is a drawing.
void set_stage(ReadScene& scene, const CompiledScene& compiled);

}  // namespace fathom::compiler
