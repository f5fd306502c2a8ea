// Digests of a scene as it was compiled: films carry them, and so do pictures that have attributes.
// Tested by: tests/runtime/cli/picture/cli_layers_test.cpp, tests/runtime/cli/picture/cli_checkpoint_test.cpp
#pragma once

#include <string>

#include "compiler/scene/compiled_scene.h"

namespace fathom::cli {

// Digests in hexadecimal: of all that the scene was compiled to, but for its film and settings; of its programs.
std::string scene_hash(const compiler::CompiledScene& scene);
std::string program_hash(const compiler::CompiledScene& scene);

}  // namespace fathom::cli
