// The front ends together: which of the formats a text is in, and the scene it describes.
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
  syntax::File file;  // what an ordinary scene file would have said
  std::optional<Scope> parameters = {};  // of a text, which is read with their values
};

// nullopt after reporting an error. What a text imports is added to the source.
std::optional<ReadScene> read_scene(Source& source, Diagnostics& diagnostics, const Limits& limits = {},
                                    const Definitions& definitions = {}, const ImportReader& imports = {});

// A text as a JSON scene that keeps its parameters (frontend/text/read_text.h).
std::optional<KeptScene> read_kept(Source& source, Diagnostics& diagnostics, const Limits& limits = {},
                                   const ImportReader& imports = {});

}  // namespace fathom::compiler
