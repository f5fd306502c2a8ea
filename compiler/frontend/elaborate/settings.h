// The parts of a scene that are not nodes: camera, film, render settings. Lights and background: lights.h; materials:
// materials.h. Tested by: tests/compiler/frontend/elaborate/elaborate_test.cpp, tests/golden/diagnostics (E01xx, E0303, E0304)
#pragma once

#include "compiler/frontend/syntax/scope.h"
#include "compiler/frontend/syntax/syntax.h"
#include "compiler/scene/compiled_scene.h"
#include "compiler/source/diagnostics.h"

namespace fathom::compiler {

// Each reads, with the scene's parameters in `scope`, the value of the scene's property of that name and reports what
// is wrong with it; the result is of no use when anything was.
Camera read_camera(const syntax::Value& value, const Scope& scope, Diagnostics& diagnostics);
Film read_film(const syntax::Value& value, const Scope& scope, Diagnostics& diagnostics);
RenderSettings read_render(const syntax::Value& value, const Scope& scope, Diagnostics& diagnostics);

}  // namespace fathom::compiler
