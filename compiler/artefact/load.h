// A compiled file on its way to a render: what in it no check can show is proved by compiling its text again.
// Tested by: tests/compiler/artefact/artefact_test.cpp, tests/runtime/cli/cli_compile_test.cpp
#pragma once

#include <optional>
#include <span>
#include <string>
#include <variant>

#include "compiler/artefact/compiled_file.h"

namespace fathom::compiler {

// What a file of compiled programs, `path`, holds.
struct StoredScene {
  CompiledScene scene;    // claims, not proofs
  FileContents contents;  // with text, scene.source is what it was compiled from, with these definitions
};
[[nodiscard]] std::variant<StoredScene, FileError> read_stored(std::span<const std::uint8_t> bytes,
                                                               const std::string& path);

// The scene's text in such a file, as if it lay beside it, though its programs may be for another machine.
struct StoredText {
  Source source;
  Definitions definitions;
};
[[nodiscard]] std::variant<StoredText, FileError> read_stored_text(std::span<const std::uint8_t> bytes,
                                                                   const std::string& path);

// The stored scene for use without a proof. Its constants are those that intervals show, which is seldom the best, or
// estimates where they show nothing; its bound counts where they show that nothing is outside, and its lamps are
// found by the rays that hit them alone.
CompiledScene unproved(CompiledScene stored);

}  // namespace fathom::compiler
