// The library of scenes/lib, which every text can import: `import "std/gears" as gears`. CMake embeds its files.
// Tested by: tests/compiler/frontend/text/text_imports_test.cpp
#pragma once

#include <span>

#include "compiler/source/embedded_file.h"

namespace fathom::compiler::text {

// Returns the files by names such as "gears".
std::span<const EmbeddedFile> standard_files();

}  // namespace fathom::compiler::text
