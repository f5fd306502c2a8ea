// What is sound but surely not meant, or dear: parts that never show, blends wider than what they join, features
// thinner than floats tell apart, lamps that cannot shine, warps that make steps many times shorter. Warnings W05xx.
//
// Parts that are found by boxes and a look with intervals (compiler/containment.h): what is reported is so, and more
// may be.
// Tested by: tests/golden/diagnostics (W05xx)
#pragma once

#include "compiler/compiled_scene.h"
#include "compiler/diagnostics.h"
#include "compiler/graph.h"

namespace fathom::compiler {

// `scene` is the graph before the first pass, `surface` its program.
void lint(const Scene& scene, const SceneTables& tables, const vm::VerifiedProgram& surface,
          Diagnostics& diagnostics);

// The one of them that every compilation reports (W0509), for with it a picture may be wrong.
void warn_of_unbounded_formulas(const Scene& scene, Diagnostics& diagnostics);

}  // namespace fathom::compiler
