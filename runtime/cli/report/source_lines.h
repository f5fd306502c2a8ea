// A scene's text as HTML: numbered lines with their share of the program's cost, comments and texts in colours.
// Tested by: tests/runtime/cli/cli_report_test.cpp
#pragma once

#include <string>

#include "compiler/scene/compiled_scene.h"

namespace fathom::cli {

// Returns one <tr> per line of the scene's file, of the columns number, cost and text. The cost is the share of the
// surface program's instructions that the line causes; instructions of imports belong to no line.
std::string source_lines(const compiler::CompiledScene& scene);

}  // namespace fathom::cli
