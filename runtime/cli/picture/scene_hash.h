// Digests of a compiled scene, stored in films and in images with attributes.
// Tested by: tests/runtime/cli/picture/cli_layers_test.cpp, tests/runtime/cli/picture/cli_checkpoint_test.cpp
#pragma once

#include <string>

#include "compiler/scene/compiled_scene.h"

namespace fathom::cli {

// Hexadecimal digests of the whole compiled scene except its film and settings, and of its programs.
std::string scene_hash(const compiler::CompiledScene& scene);
std::string program_hash(const compiler::CompiledScene& scene);

}  // namespace fathom::cli
