// Readers for light sources that are not solids: lights and the background.
// Tested by: tests/compiler/frontend/elaborate/elaborate_test.cpp, area_lights_test.cpp, tests/golden/diagnostics
// (E0309, E0310)
#pragma once

#include <vector>

#include "compiler/frontend/syntax/scope.h"
#include "compiler/frontend/syntax/syntax.h"
#include "compiler/scene/compiled_scene.h"
#include "compiler/source/diagnostics.h"

namespace fathom::compiler {

// Same conventions as the readers in settings.h.
Background read_background(const syntax::Value& value, const Scope& scope, Diagnostics& diagnostics);
std::vector<Light> read_lights(const syntax::Value& value, const Scope& scope,
                               Diagnostics& diagnostics);  // in file order

}  // namespace fathom::compiler
