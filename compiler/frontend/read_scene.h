// Entry point of the front ends: detects the format of a source and reads the scene in it.
// Tested by: tests/compiler/frontend/formats/expression_list_test.cpp, tests/compiler/frontend/formats/nested_nodes_test.cpp
#pragma once

#include <optional>

#include "compiler/frontend/records/parameters.h"
#include "compiler/frontend/syntax/syntax.h"
#include "compiler/frontend/text/read_text.h"
#include "compiler/source/diagnostics.h"
#include "compiler/source/limits.h"

namespace fathom::compiler {

enum class SceneFormat { Scene, Text, ExpressionList, NestedNodes };

struct ReadScene {
  SceneFormat format;
  syntax::File file;  // the scene as a JSON scene file would describe it
  // Text scenes only: the parameters, whose values the text was evaluated with.
  std::optional<Scope> parameters = {};
};

// Returns nullopt after reporting an error. Adds the imports of a text scene to `source`.
std::optional<ReadScene> read_scene(Source& source, Diagnostics& diagnostics, const Limits& limits = {},
                                    const Definitions& definitions = {}, const ImportReader& imports = {});

// Reads a text scene as a JSON scene that keeps its parameters (compiler/frontend/text/read_text.h).
std::optional<SceneWithFormulas> read_with_formulas(Source& source, Diagnostics& diagnostics,
                                                    const Limits& limits = {}, const ImportReader& imports = {});

}  // namespace fathom::compiler
