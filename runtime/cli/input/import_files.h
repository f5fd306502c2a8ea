// The files that a scene imports, as they are read from its folder.
// Tested by: tests/runtime/cli/input/cli_imports_test.cpp
#pragma once

#include "compiler/frontend/text/parse/imports.h"
#include "runtime/cli/input/scene_arguments.h"

namespace fathom::cli {

// Reads what lies below `--root`, which is the scene's folder where it is not given, links followed.
compiler::ImportReader import_reader(const SceneArguments& arguments, const Streams& streams);

}  // namespace fathom::cli
