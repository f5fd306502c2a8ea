// Simplification of a closed mesh by edge collapses, each of which is proved: a collapse is accepted only if all
// triangles that it changes lie within the tolerance of the surface (runtime/mesh/distance_proof.h).
//
// Blocks of the mesh are simplified side by side, each up to the triangles that reach into another block, and then
// the whole.
//
// The order of collapses follows the quadrics of the exact tangent planes. A collapse keeps the mesh a closed
// manifold (the link condition), turns no triangle over, and keeps the borders between materials.
//
// Sources: Garland and Heckbert, "Surface simplification using quadric error metrics", 1997; Dey et al., "Topology
// preserving edge contraction", 1999 (the link condition).
// Tested by: tests/runtime/mesh/simplify_test.cpp
#pragma once

#include "runtime/mesh/collapse.h"

namespace fathom::runtime {

// Simplifies the mesh in place. The result depends on the arguments alone.
void simplify(const MeshField& field, Contour& contour, const SimplifyOptions& options);

}  // namespace fathom::runtime
