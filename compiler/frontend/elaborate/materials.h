// The materials of a scene: plain ones, OpenPBR's, named substances, and parameters that vary over space.
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

// Reads, with the scene's parameters in `scope`, the scene's property `materials`, a record, and reports what is
// wrong with it; the result is of no use when anything was.
MaterialTables read_materials(const syntax::Value& value, const Scope& scope, Diagnostics& diagnostics);

}  // namespace fathom::compiler
