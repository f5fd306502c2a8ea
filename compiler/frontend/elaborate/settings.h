// Readers for the parts of a scene that are not nodes: camera, film and render settings. See lights.h for lights and
// background, and materials.h for materials.
// Tested by: tests/compiler/frontend/elaborate/elaborate_test.cpp, tests/golden/diagnostics (E01xx, E0303, E0304)
#pragma once

#include "compiler/frontend/syntax/scope.h"
#include "compiler/frontend/syntax/syntax.h"
#include "compiler/scene/compiled_scene.h"
#include "compiler/source/diagnostics.h"

namespace fathom::compiler {

// Each function reads the value of the scene's property of that name, with the scene's parameters in `scope`, and
// reports errors. The result is meaningless after an error.
Camera read_camera(const syntax::Value& value, const Scope& scope, Diagnostics& diagnostics);
Film read_film(const syntax::Value& value, const Scope& scope, Diagnostics& diagnostics);
RenderSettings read_render(const syntax::Value& value, const Scope& scope, Diagnostics& diagnostics);

}  // namespace fathom::compiler
