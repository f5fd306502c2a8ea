// An example of each code of an error or a warning that a text can show: a file, the line `----- expected`, and its
// message. CMake embeds one of the files in tests/golden/diagnostics per code, a text before a JSON scene.
// Tested by: tests/runtime/cli/cli_explain_test.cpp
#pragma once

#include <span>

#include "compiler/source/embedded_file.h"

namespace fathom::cli {

std::span<const compiler::EmbeddedFile> error_examples();

}  // namespace fathom::cli
