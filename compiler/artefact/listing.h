// A compiled scene as text without loss: the output of `fathom dump --stage file` and the input of `fathom asm`.
//
//     fathom 6
//     machine 6f1c...            ; the digest of the opcodes
//     tables {
//       "summary": "1 node, ...",
//       ...
//     }
//     program distance {
//       ... a listing (vm/encoding/disassemble.h)
//     }
//     text "scene.json"
//     |{
//     |  "version": 1,
//     ...
//
// The reader also takes the listing of a single program: a scene of the program in white, with the default camera.
// Tested by: tests/compiler/artefact/artefact_test.cpp
#pragma once

#include <optional>
#include <string>

#include "compiler/artefact/compiled_file.h"
#include "compiler/source/diagnostics.h"

namespace fathom::compiler {

std::string write_listing(const CompiledScene& scene, const FileContents& contents = {});

// Returns nothing after reporting an error. Sets `contents` to the contents of the listing.
std::optional<CompiledScene> read_listing(const Source& listing, Diagnostics& diagnostics, FileContents& contents,
                                          const Limits& limits = {});

}  // namespace fathom::compiler
