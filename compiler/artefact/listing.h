// A compiled scene as text that loses nothing: what `fathom dump --stage file` prints and `fathom asm` reads.
//
//     fathom 3
//     machine 6f1c...            ; the digest of the opcodes
//     tables {
//       summary "1 node, ..."
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
// A listing of one program alone is read, too: a scene of it in white, with the default camera and nothing proved.
// Tested by: tests/compiler/artefact/artefact_test.cpp
#pragma once

#include <optional>
#include <string>

#include "compiler/artefact/compiled_file.h"
#include "compiler/source/diagnostics.h"

namespace fathom::compiler {

std::string write_listing(const CompiledScene& scene, const FileContents& contents = {});

// nullopt after reporting an error. What was not written comes back empty; `contents` says what was.
std::optional<CompiledScene> read_listing(const Source& listing, Diagnostics& diagnostics, FileContents& contents);

}  // namespace fathom::compiler
