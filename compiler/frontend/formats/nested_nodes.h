// Reader for trees of primitives and binary operators in the format of the program of Barbier, Sanchez, Paris,
// Michel, Lambert, Boubekeur, Paulin and Thonat, "Lipschitz Pruning: Hierarchical Simplification of Primitive-Based
// SDFs" (2025): JSON with a `nodeType` in every node and the model's bounding box at the root.
//
//     {"aabb_min": [-1, -1, -1], "aabb_max": [1, 1, 1],
//      "nodeType": "binaryOperator", "blendMode": "union", "blendRadius": 0.1, "matrix": [...],
//      "leftChild": {"nodeType": "primitive", "primitiveType": "sphere", "radius": 0.5, "color": [1, 0, 0], ...},
//      "rightChild": ...}
//
// Semantics, as in that program (src/scene.cpp and shaders/common.glsl of its repository, commit 684d606b):
//   - the blend kernel is max(0, k - |a - b|)^2 / 4k, so blendRadius is our k: the surface moves by at most k/4;
//   - matrix, 12 numbers row by row, maps points INTO the node's space: a sphere with the last column t is centred at
//     -t. A point passes through the primitive's matrix first, then its parent's, then the root's;
//   - distances are not scaled, so matrices must be rotations or reflections with a translation. All primitives are
//     symmetric enough to turn a reflection into a rotation;
//   - `sides` and `height` are whole lengths. round_x and round_y round a box's upper and lower edges, `bevel` its
//     upright edges. The other primitives ignore all three.
// Boxes must have no rounding, or the same rounding on all edges.
// Tested by: tests/compiler/frontend/formats/nested_nodes_test.cpp, tests/golden/diagnostics (E0611 to E0614)
#pragma once

#include <optional>

#include "compiler/frontend/syntax/syntax.h"
#include "compiler/source/diagnostics.h"

namespace fathom::compiler {

// True for an object with `nodeType` and without `version`.
bool is_nested_nodes(const syntax::File& file);

// Returns the model as an ordinary scene in front of a camera, or nullopt after a report.
std::optional<syntax::File> from_nested_nodes(const syntax::File& file, Diagnostics& diagnostics);

}  // namespace fathom::compiler
