// The fields of a compiled scene except its programs: the one list by which its tables are written and read. The
// ranges are all that the renderer relies on. Tested by: tests/compiler/artefact/artefact_test.cpp
#pragma once

#include "compiler/artefact/archive.h"
#include "compiler/scene/compiled_scene.h"

namespace fathom::compiler {

// Everything except `source` and the programs. Reading, `scene` has its programs, and as many media as there are
// programs of media. An index refers to an element that is there.
void fields(Archive& archive, CompiledScene& scene);

TableJson tables_of(const CompiledScene& scene);
void read_tables(Archive& archive, CompiledScene& scene);  // of all JSON that the reader `archive` has

// Completes the name of the background's image file, which lies beside `source`. Call after reading, once `source`
// has its name.
void resolve_image_path(CompiledScene& scene);

}  // namespace fathom::compiler
