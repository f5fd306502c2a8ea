// From a scene as written to a scene that means something: names resolved, parameters checked, the DAG built.
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

// The scene with its tables; `scene.root` is the union of the objects, each in a Paint node with its surface.
struct Elaborated : SceneTables {
  Scene scene;                   // of nodes as described (compiler/derive/derive.h)
  std::vector<Span> type_spans;  // [node] of the word that names the node's type; of the first nodes
  std::vector<Scene> formulas;   // of the textures, as numbers
};

// Reports every semantic error of the file; nullopt when there was any. `definitions` are values for the scene's
// parameters in place of its own; `parameters` are what they came to, where the file was read with them.
std::optional<Elaborated> elaborate(const syntax::File& file, Diagnostics& diagnostics,
                                    const Definitions& definitions = {}, const Limits& limits = {},
                                    std::optional<Scope> parameters = std::nullopt);

}  // namespace fathom::compiler
