// The files that a scene's text imports, all read before anything is evaluated: which they are does not depend on
// the scene's parameters.
//
//     import "lib/gears.fathom"(module = 0.3) as gears
//
// A path is relative to the file that has it, with / between names. Files of other formats than text are read as the
// text that `fathom convert` makes of them.
// Tested by: tests/compiler/frontend/text/text_imports_test.cpp, tests/golden/diagnostics (E0810)
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <variant>

#include "compiler/source/diagnostics.h"
#include "compiler/source/limits.h"

namespace fathom::compiler {

// Why a file cannot be imported, and what to do about it.
struct ImportFault {
  std::string reason;
  std::string remedy = "";
};

// Reads the file at a path from the scene's folder, as `lib/gears.fathom`; `..` is at its begin only.
using ImportReader = std::function<std::variant<std::string, ImportFault>(const std::string& path)>;

// Makes text of a scene in another format; nullopt after an error.
using TextMaker = std::function<std::optional<std::string>(const Source& scene, Diagnostics& diagnostics)>;

namespace text {

struct Tree;
struct ParsedFile;
struct Module;

// Adds a file's statements as another module.
void append(Tree& tree, ParsedFile file, Module module);

// Files that are imported, and modules made of them.
inline constexpr std::size_t kMostImports = 256;

// Adds the modules of all files that the tree's statements import. Files that the source has are not read again; the
// others are added to it. Reports what is wrong with any of them.
void load_imports(Tree& tree, Source& source, const ImportReader& reader, const TextMaker& to_text,
                  const Limits& limits, Diagnostics& diagnostics);

}  // namespace text
}  // namespace fathom::compiler
