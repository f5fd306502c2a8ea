// Reader for scenes in Fathom's own notation (docs/reference/language.md), such as
//
//     fathom 1
//     def post(height) = cylinder(0.1, height/2).translate([0, height/2, 0])
//     object "posts" [for i in 0..5: post(1 + i/4).translate([i, 0, 0])]
//
// Tested by: tests/compiler/frontend/text/text_evaluate_test.cpp, tests/golden/diagnostics (E08xx)
#pragma once

#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "compiler/frontend/formats/write_json.h"
#include "compiler/frontend/records/parameters.h"
#include "compiler/frontend/syntax/syntax.h"
#include "compiler/frontend/text/parse/imports.h"
#include "compiler/source/diagnostics.h"
#include "compiler/source/limits.h"

namespace fathom::compiler {

// True if the text is in this notation: its first word is `fathom`.
bool is_text_scene(std::string_view text);
// True also if the author forgot that word: the file is named *.fathom, or begins with a statement word.
bool is_meant_as_text(const Source& source);

// Access to the files that a text imports. The reader adds them to the text's source.
struct ImportedFiles {
  ImportReader reader = {};
  TextMaker to_text = {};
};

// Returns the scene, as a JSON file would describe it, and its parameters. Returns nullopt if the text cannot be
// parsed or has no objects. After other errors the scene is incomplete.
std::optional<std::pair<syntax::File, Scope>> read_text_scene(Source& source, const Definitions& definitions,
                                                              const Limits& limits, Diagnostics& diagnostics,
                                                              const ImportedFiles& files = {});

// Returns the text's comments, keyed by the part of the scene that each comment precedes or follows on its line.
// Comments of functions go to the next part.
JsonComments comments_of_text(const Source& source, const syntax::File& file);

// Scene whose numbers are formulas of its parameters where possible, and the places where that is impossible.
struct SceneWithFormulas {
  syntax::File file;
  std::vector<Span> frozen;  // places that depend on parameter values: conditions, ranges, indices
};

// Reads the same scene as a JSON file that keeps the parameters.
std::optional<SceneWithFormulas> read_text_with_formulas(Source& source, const Limits& limits,
                                                         Diagnostics& diagnostics, const ImportedFiles& files = {});

}  // namespace fathom::compiler
