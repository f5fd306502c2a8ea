// Import reader for scene texts: finds imported files in a folder of the project.
#pragma once

#include <filesystem>

#include "compiler/frontend/text/parse/imports.h"
#include "tests/support/golden.h"

namespace fathom::test {

inline compiler::ImportReader imports_from(const std::filesystem::path& folder) {
  return [folder](const std::string& path) -> std::variant<std::string, compiler::ImportFault> {
    const std::filesystem::path file = folder / path;
    if (path.starts_with("..")) return compiler::ImportFault{"it is not in the scene's folder"};
    if (!std::filesystem::is_regular_file(file)) return compiler::ImportFault{"No such file or directory"};
    return read_file(file);
  };
}

}  // namespace fathom::test
