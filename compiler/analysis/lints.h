// What is sound but surely not meant, or dear: parts that never show, blends wider than what they join, features
// thinner than floats tell apart, lamps that cannot shine, warps that make steps many times shorter. Warnings W05xx.
//
// Parts that are found by boxes and a look with intervals (compiler/passes/containment.h): what is reported is so, and more
// may be.
// Tested by: tests/golden/diagnostics (W05xx)
#pragma once

#include "compiler/graph/graph.h"
#include "compiler/scene/compiled_scene.h"
#include "compiler/source/diagnostics.h"

namespace fathom::compiler {

// `scene` is the graph before the first pass, in the programs' coordinates like `tables`; `surface` is its program.
void lint(const Scene& scene, const SceneTables& tables, const vm::VerifiedProgram& surface,
          Diagnostics& diagnostics);

// Parts that are small beside their coordinates (W0512) and have no warning of being too thin yet. The programs' zero
// is at `origin`.
void lint_places(const Scene& scene, glm::dvec3 origin, Diagnostics& diagnostics);

// Offsets and blends of values that are smaller than the distance near the surface (W0511).
void lint_offsets(const Scene& scene, Diagnostics& diagnostics);

// A scene without any light, or with its only lights inside opaque solids (W0515). `surface` is its program.
void lint_light(const Scene& scene, const SceneTables& tables, const vm::VerifiedProgram& surface,
                Diagnostics& diagnostics);

// Twice the thickness of a wall, or the smallest side of a primitive's box; infinite when it has neither. `box` is
// the node's; the result is in the node's own space.
double thickness(const Graph& graph, NodeId id, const Box& box);

// The one of them that every compilation reports (W0509), for with it a picture may be wrong.
void warn_of_unbounded_formulas(const Scene& scene, Diagnostics& diagnostics);

}  // namespace fathom::compiler
