// Scenes in Fathom's own notation (docs/LANGUAGE.md), such as
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

// Whether a text is in this notation: its first word is `fathom`.
bool is_text_scene(std::string_view text);
// Or its author forgot that: it is in a file *.fathom, or begins with a word that begins a statement.
bool is_meant_as_text(const Source& source);

// The files that a text imports, which are added to its source.
struct ImportedFiles {
  ImportReader reader = {};
  TextMaker to_text = {};
};

// The scene that a JSON file would have said, and its parameters; nullopt when the text is not understood. After
// other errors it is what is left of the scene.
std::optional<std::pair<syntax::File, Scope>> read_text_scene(Source& source, const Definitions& definitions,
                                                              const Limits& limits, Diagnostics& diagnostics,
                                                              const ImportedFiles& files = {});

// The text's comments, by what of the scene each stands before or beside; those of functions before what comes next.
JsonComments comments_of_text(const Source& source, const syntax::File& file);

// A text whose numbers are formulas of its parameters where they can be, and where they cannot.
struct KeptScene {
  syntax::File file;
  std::vector<Span> frozen;  // what the parameters' values decided: conditions, ranges, indices
};

// The same scene as a JSON file that keeps the parameters.
std::optional<KeptScene> read_text_with_formulas(Source& source, const Limits& limits, Diagnostics& diagnostics,
                                                 const ImportedFiles& files = {});

}  // namespace fathom::compiler
