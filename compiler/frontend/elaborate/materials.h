// Reader for the materials of a scene: simple types, OpenPBR, presets, and parameters that vary over space.
// Tested by: tests/compiler/frontend/elaborate/materials_test.cpp, tests/golden/diagnostics (E01xx)
#pragma once

#include <vector>

#include "compiler/frontend/syntax/scope.h"
#include "compiler/frontend/syntax/syntax.h"
#include "compiler/graph/graph.h"
#include "compiler/scene/compiled_scene.h"
#include "compiler/source/diagnostics.h"

namespace fathom::compiler {

struct MaterialTables {
  std::vector<Material> materials;  // in file order
  std::vector<Texture> textures;
  std::vector<Scene> formulas;  // of the textures
};

// Reads the scene's property `materials`, a record, with the scene's parameters in `scope`. Reports errors. The
// result is meaningless after an error.
MaterialTables read_materials(const syntax::Value& value, const Scope& scope, Diagnostics& diagnostics);

}  // namespace fathom::compiler
