// The default scenes of `fathom chart`, by their paths in the project. CMake embeds the files' texts into the program.
// Tested by: tests/runtime/cli/cli_chart_test.cpp
#pragma once

#include <span>

#include "compiler/source/embedded_file.h"

namespace fathom::cli {

std::span<const compiler::EmbeddedFile> chart_scenes();

}  // namespace fathom::cli
