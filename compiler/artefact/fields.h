// What each part of a compiled scene consists of, beside its programs: the one list that files of compiled scenes,
// as bytes and as text, are written and read by. Ranges are what the renderer relies on.
// Tested by: tests/compiler/artefact/artefact_test.cpp
#pragma once

#include "compiler/artefact/archive.h"
#include "compiler/scene/compiled_scene.h"

namespace fathom::compiler {

// All but `source` and the programs. Reading, `scene` has its programs, and as many media as there are programs of
// media; what refers to something refers to something that is there.
void fields(Archive& archive, CompiledScene& scene);

// After reading, once `source` has its name: the picture that the background names lies beside it.
void place_picture(CompiledScene& scene);

// Of its parts.
void fields(Archive& archive, Parameter& parameter);
void fields(Archive& archive, Camera& camera);
void fields(Archive& archive, Film& film);
void fields(Archive& archive, RenderSettings& settings);
void fields(Archive& archive, Background& background);
void fields(Archive& archive, Light& light);
void fields(Archive& archive, CompiledField& field);

}  // namespace fathom::compiler
