// Reads the files that a scene imports.
// Tested by: tests/runtime/cli/input/cli_imports_test.cpp
#pragma once

#include "compiler/frontend/text/parse/imports.h"
#include "runtime/cli/input/scene_arguments.h"

namespace fathom::cli {

// Returns a reader for files below `--root`, by default the scene's folder. Links are resolved before the check. Adds
// the files to the inputs in `streams`.
compiler::ImportReader import_reader(const SceneArguments& arguments, const Streams& streams);

}  // namespace fathom::cli
