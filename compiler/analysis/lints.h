// Lints: warnings W05xx of scenes that are valid but surely unintended or expensive. Examples are parts that never
// show, blends wider than their operands, features thinner than float resolution, area lights that cannot shine, and
// warps that make steps many times shorter.
//
// Boxes and one interval evaluation (compiler/passes/containment.h) find hidden and empty parts. Every report is
// true, but some of these parts may go unreported.
// Tested by: tests/golden/diagnostics (W05xx)
#pragma once

#include "compiler/graph/graph.h"
#include "compiler/scene/compiled_scene.h"
#include "compiler/source/diagnostics.h"

namespace fathom::compiler {

// Reports every lint except those of the functions below. `scene` is the graph before the first pass, in the
// programs' coordinates like `tables`. `surface` is its surface program.
void lint(const Scene& scene, const SceneTables& tables, const vm::VerifiedProgram& surface,
          Diagnostics& diagnostics);

// Warns of parts that are too small for their coordinates (W0512), except those with a warning of thinness (W0506)
// already. The programs' zero is at `origin`.
void lint_places(const Scene& scene, glm::dvec3 origin, Diagnostics& diagnostics);

// Warns of offsets and blends of values that are smaller than the distance near the surface (W0511).
void lint_offsets(const Scene& scene, Diagnostics& diagnostics);

// Warns of a scene without any light, or with its only lights inside opaque solids (W0515). `surface`: its surface
// program.
void lint_light(const Scene& scene, const SceneTables& tables, const vm::VerifiedProgram& surface,
                Diagnostics& diagnostics);

// Returns twice the thickness of a wall, or the smallest side of a primitive's box; infinite for other nodes. `box`
// is the node's bounding box. The result is in the node's own space.
double thickness(const Graph& graph, NodeId id, const Box& box);

// Warns of formulas whose slope has no proved bound (W0509). Every compilation reports W0509, because the image may
// be wrong.
void warn_of_unbounded_formulas(const Scene& scene, Diagnostics& diagnostics);

}  // namespace fathom::compiler
