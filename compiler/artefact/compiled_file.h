// A compiled scene as a file, .fbc: its programs, its tables, the places of its instructions in the text, and the
// text that it was compiled from. docs/reference/bytecode.md has the layout, byte by byte.
//
//     std::vector<std::uint8_t> bytes = write_file(scene, {});
//     auto stored = read_stored(bytes, path);    // StoredScene, or FileError
//
// write_listing() and read_listing() (compiler/artefact/listing.h) have the same as text.
//
// The reader verifies programs, and checks tables for everything that memory safety relies on. Bounds and constants
// are claims: a render believes them, and `fathom check` proves them again from the text. Tested by:
// tests/compiler/artefact/artefact_test.cpp
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "compiler/frontend/records/parameters.h"
#include "compiler/scene/compiled_scene.h"
#include "compiler/source/limits.h"
#include "vm/encoding/digest.h"

namespace fathom::compiler {

inline constexpr std::array<std::uint8_t, 8> kFileMagic = {0x89, 'F', 'B', 'C', '\r', '\n', 0x1a, '\n'};
inline constexpr std::uint32_t kFileVersion = 6;

// Contents of a file in addition to programs and tables.
struct FileContents {
  bool debug = true;             // places and names of the instructions
  bool text = true;              // the scene's text, which proofs and parameters need
  Definitions definitions = {};  // values of the text's parameters
};

struct FileError {
  std::string reason;     // with the section and the place in it
  std::string remedy;     // may be empty
  bool textless = false;  // the file is valid, but lacks the text that the caller needs
};

bool is_compiled_file(std::string_view bytes);

std::vector<std::uint8_t> write_file(const CompiledScene& scene, const FileContents& contents = {});

// The contents of a file. With text, scene.source is the text, as if it lay beside the file.
struct StoredScene {
  CompiledScene scene;  // `bound`, `lipschitz` and the other facts are claims
  FileContents contents;
};
// Reads the file `path`. Refuses programs for another table of opcodes, and more words than programs within `limits`
// have: a few bytes of rows can ask for any number.
[[nodiscard]] std::variant<StoredScene, FileError> read_stored(std::span<const std::uint8_t> bytes,
                                                               const std::string& path, const Limits& limits = {});

// The text of a file, whose programs may be for another table of opcodes.
struct StoredText {
  Source source;
  Definitions definitions;
};
[[nodiscard]] std::variant<StoredText, FileError> read_stored_text(std::span<const std::uint8_t> bytes,
                                                                   const std::string& path);

// Returns the files that a scene imports, except texts derived from other texts.
std::vector<Import> files_of(const Source& source);
// Adds an import under its path in the file or listing. Returns false if no import can have the path.
[[nodiscard]] bool add_import(Source& source, const std::string& path, std::string text);

// Returns a digest of everything that decides the image: programs and tables, not names of instructions, not the
// text. `settings`: with `film` and `render`, which the command line may override.
vm::Digest scene_digest(const CompiledScene& scene, bool settings = true);
// Returns a digest of the programs and their place.
vm::Digest program_digest(const CompiledScene& scene);

}  // namespace fathom::compiler
