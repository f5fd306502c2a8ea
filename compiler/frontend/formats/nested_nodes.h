// Trees of primitives and binary operators as the program of Barbier, Sanchez, Paris, Michel, Lambert, Boubekeur,
// Paulin and Thonat, "Lipschitz Pruning: Hierarchical Simplification of Primitive-Based SDFs" (2025) stores them: JSON
// with a `nodeType` everywhere and the model's box at the root.
//
//     {"aabb_min": [-1, -1, -1], "aabb_max": [1, 1, 1],
//      "nodeType": "binaryOperator", "blendMode": "union", "blendRadius": 0.1, "matrix": [...],
//      "leftChild": {"nodeType": "primitive", "primitiveType": "sphere", "radius": 0.5, "color": [1, 0, 0], ...},
//      "rightChild": ...}
//
// As that program reads them (src/scene.cpp and shaders/common.glsl of its repository, commit 684d606b):
//   - its kernel is max(0, k - |a - b|)^2 / 4k, so blendRadius is our k: the surface moves by at most k/4;
//   - matrix, 12 numbers row by row, takes points INTO the node's space: a sphere with the last column t is centred at
//     -t. A point goes through the primitive's matrix first, then its parent's, then the root's;
//   - distances are not scaled, so matrices must be rotations or reflections with a move; all primitives are symmetric
//     enough for a reflection to be a rotation;
//   - `sides` and `height` are whole lengths; round_x and round_y round a box's upper and lower edges, `bevel` its
//     upright ones, and are ignored by the other primitives.
// Of boxes only those without rounding, or with the same everywhere, are known here.
// Tested by: tests/compiler/frontend/formats/nested_nodes_test.cpp, tests/golden/diagnostics (E0611 to E0614)
#pragma once

#include <optional>

#include "compiler/frontend/syntax/syntax.h"
#include "compiler/source/diagnostics.h"

namespace fathom::compiler {

// An object with `nodeType` and without `version`.
bool is_nested_nodes(const syntax::File& file);

// The same as an ordinary scene in front of a camera; nullopt after reporting what is wrong.
std::optional<syntax::File> from_nested_nodes(const syntax::File& file, Diagnostics& diagnostics);

}  // namespace fathom::compiler
