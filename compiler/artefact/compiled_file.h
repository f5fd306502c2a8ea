// A compiled scene as a file, .fbc: everything a render reads of it, where its instructions come from, and the text
// it was compiled from. docs/reference/bytecode.md has the layout, byte by byte.
//
//     std::vector<std::uint8_t> bytes = write_file(scene, {});
//     auto file = open_file(bytes);                    // CompiledFile, or FileError
//     auto stored = read_file(file, path);             // CompiledScene, or FileError
//
// The same as text, for people and for tools that know no bytes: write_listing() and read_listing() are inverse.
//
// Nothing in a file is believed. Programs are verified; tables are checked for everything the renderer relies on;
// what no check can show, bounds and constants, is proved again by compiling the text (compiler/artefact/load.h).
// Tested by: tests/compiler/artefact/artefact_test.cpp, tests/golden (artefacts)
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
#include "vm/encoding/digest.h"

namespace fathom::compiler {

inline constexpr std::array<std::uint8_t, 8> kFileMagic = {0x89, 'F', 'B', 'C', '\r', '\n', 0x1a, '\n'};
inline constexpr std::uint32_t kFileVersion = 3;

// What a file holds beside programs and tables.
struct FileContents {
  bool debug = true;             // places and names of the instructions
  bool text = true;              // the scene's text: without it nothing is proved and no parameter can be set
  Definitions definitions = {};  // the values that parameters of the text were given
};

struct FileError {
  std::string reason;     // with the section and the offset in it; for people
  std::string remedy;     // may be empty
  bool textless = false;  // nothing is wrong with it, but it came without the scene's text, which was asked for
};

// A file cut into its sections, whose digests are right.
struct CompiledFile {
  vm::Digest opcodes;  // of the table the programs were made for
  std::span<const std::uint8_t> code, tables, debug;
  std::optional<Source> text;  // under its file's name, without folders, with what it imports
  Definitions definitions;     // with which it was compiled
};

bool is_compiled_file(std::string_view bytes);

std::vector<std::uint8_t> write_file(const CompiledScene& scene, const FileContents& contents = {});
[[nodiscard]] std::variant<CompiledFile, FileError> open_file(std::span<const std::uint8_t> bytes);

// What the sections say, as if its text lay beside the file, `path`; `bound`, `lipschitz` and their like are claims.
// Refused when the programs are of another table of opcodes.
[[nodiscard]] std::variant<CompiledScene, FileError> read_file(const CompiledFile& file, const std::string& path);

// The files that a scene imports, without texts that were made of others.
std::vector<Import> files_of(const Source& source);
// Adds one as a compiled file or a listing has it; false when no import has such a path.
[[nodiscard]] bool add_import(Source& source, const std::string& path, std::string text);

// The text as if it lay beside the file, `path`.
Source beside(const Source& text, const std::string& path);

// Of everything that decides what is rendered: code and tables, not names of instructions or the text.
vm::Digest scene_digest(const CompiledScene& scene);

}  // namespace fathom::compiler
