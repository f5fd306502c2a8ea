// The library of scenes/lib, which every text can import: `import "std/gears" as gears`. CMake embeds its files.
// Tested by: tests/compiler/frontend/text/text_imports_test.cpp, tests/golden/diagnostics (E0810_standard)
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace fathom::compiler::text {

struct StandardFile {
  std::string_view name, text;  // such as "gears"
};
std::span<const StandardFile> standard_files();

// True if an import's path, as written, is one of the library.
inline bool is_standard(std::string_view path) { return path.starts_with("std/"); }

// Returns the file at a path such as "std/gears" or "std/gears.fathom", or nullptr.
const StandardFile* find_standard(std::string_view path);

}  // namespace fathom::compiler::text
