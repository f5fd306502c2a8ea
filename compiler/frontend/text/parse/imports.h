// Loader for the files that a text imports. Loads every file before evaluation: the set of files does not depend on
// the scene's parameters.
//
//     import "lib/gears.fathom"(module = 0.3) as gears
//
// A path is relative to the file that contains it, with / between names, or one of the library (standard_files.h).
// Files in other formats are converted to text, as `fathom convert` does.
// Tested by: tests/compiler/frontend/text/text_imports_test.cpp, tests/golden/diagnostics (E0810)
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <variant>

#include "compiler/source/diagnostics.h"
#include "compiler/source/limits.h"

namespace fathom::compiler {

// Reason why a file cannot be imported, and a remedy.
struct ImportFault {
  std::string reason;
  std::string remedy = "";
};

// Reads the file at a path relative to the scene's folder, such as `lib/gears.fathom`. The path may contain `..` only
// at its beginning.
using ImportReader = std::function<std::variant<std::string, ImportFault>(const std::string& path)>;

// Converts a scene in another format to text. Returns nullopt after an error.
using TextMaker = std::function<std::optional<std::string>(const Source& scene, Diagnostics& diagnostics)>;

namespace text {

struct Tree;
struct ParsedFile;
struct Module;

// Adds a file's statements to the tree as a new module.
void append(Tree& tree, ParsedFile file, Module module);

// Maximum number of modules for imported files.
inline constexpr std::size_t kMaxImports = 256;

// Adds the modules of all files that the tree's statements import. Reuses the files that `source` already contains,
// and adds the others to `source`. Reports errors in all of them.
void load_imports(Tree& tree, Source& source, const ImportReader& reader, const TextMaker& to_text,
                  const Limits& limits, Diagnostics& diagnostics);

}  // namespace text
}  // namespace fathom::compiler
