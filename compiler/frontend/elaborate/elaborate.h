// Elaboration of a scene as written: resolves names, checks parameters and builds the DAG.
// Tested by: tests/golden (diagnostics), tests/compiler/frontend/elaborate/elaborate_test.cpp
#pragma once

#include <optional>
#include <vector>

#include "compiler/frontend/records/parameters.h"
#include "compiler/frontend/syntax/syntax.h"
#include "compiler/graph/graph.h"
#include "compiler/scene/compiled_scene.h"
#include "compiler/source/diagnostics.h"
#include "compiler/source/limits.h"

namespace fathom::compiler {

// Scene with its tables. `scene.root` is the union of the objects, each below a Paint node with its surface.
struct ElaboratedScene : SceneTables {
  Scene scene;  // described nodes (compiler/derive/derive.h)
  // [node] span of the word that names the node's type. May be shorter than the list of nodes.
  std::vector<Span> type_spans;
  std::vector<Scene> formulas;  // number-valued fields of the textures
};

// Reports every semantic error of the file and returns nullopt if there was one. `definitions` override the values of
// the scene's parameters. `parameters` are the resulting parameters, if the front end already evaluated the file with
// them.
std::optional<ElaboratedScene> elaborate(const syntax::File& file, Diagnostics& diagnostics,
                                         const Definitions& definitions = {}, const Limits& limits = {},
                                         std::optional<Scope> parameters = std::nullopt);

}  // namespace fathom::compiler
