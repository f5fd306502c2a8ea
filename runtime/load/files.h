// Reading of scene files and of the files that they import, without messages: the program and the library
// (bindings/) word their own.
// Tested by: tests/runtime/cli/input/cli_files_test.cpp, tests/runtime/cli/input/cli_imports_test.cpp
#pragma once

#include <filesystem>
#include <functional>
#include <iosfwd>
#include <optional>
#include <string>
#include <variant>

#include "compiler/frontend/text/parse/imports.h"
#include "compiler/source/limits.h"

namespace fathom::runtime {

// Reason why a file cannot be read.
struct FileFault {
  std::string reason;
  std::string remedy = "";
  bool too_large = false;  // the file can be read, but exceeds the limit `file-size`
};

// Return the whole text without a byte order mark. Read no more than the limit `file-size`, whatever the kind of file.
std::variant<std::string, FileFault> read_file(const std::string& path, const compiler::Limits& limits);
std::variant<std::string, FileFault> read_stream(std::istream& in, const compiler::Limits& limits);

// The files that a scene may import.
struct ImportFolder {
  std::filesystem::path folder;     // of the scene, which paths of imports are relative to
  std::optional<std::string> root;  // folder of permitted imports; default: `folder`
  compiler::Limits limits;
  // Option that sets `root`, and the remedy for imports outside, for messages.
  std::string option, remedy;
  // Called with the path of each file before it is read. May be empty.
  std::function<void(const std::string& path)> on_import;
};

// Returns a reader for files below the root. Links are resolved before the check.
compiler::ImportReader import_reader(ImportFolder folder);

// Returns the limit of memory in bytes, by default three quarters of usable_memory().
double allowed_memory(const compiler::Limits& limits);

}  // namespace fathom::runtime
