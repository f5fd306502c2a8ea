// Reads the files that a scene imports.
// Tested by: tests/runtime/cli/input/cli_imports_test.cpp
#pragma once

#include "compiler/frontend/text/parse/imports.h"
#include "runtime/cli/input/scene_arguments.h"

namespace fathom::cli {

// Returns a reader for files below `--root`, by default the scene's folder. Links are resolved before the check.
compiler::ImportReader import_reader(const SceneArguments& arguments);

}  // namespace fathom::cli
