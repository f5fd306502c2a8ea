// Moves vertices of a contour that lie off the surface. A cell that a crease crosses near a corner may have crossings
// of only one side of the crease, and its vertex then lies off the other.
// Tested by: tests/runtime/mesh/make_mesh_test.cpp
#pragma once

#include "runtime/mesh/contour.h"

namespace fathom::runtime {

// Follows the gradient from each vertex that is off the surface, within its cell. A vertex stays if that brings it no
// nearer to the surface. Then turns surfaces right side out.
void move_to_surface(const MeshField& field, const CellLattice& lattice, Contour& contour, int threads);

// Moves the vertices of a connected surface to the middles of their cells if it encloses a volume of the wrong sign:
// a hollow or body hardly larger than a cell whose folds outweigh it.
void turn_right_side_out(const CellLattice& lattice, Contour& contour);

}  // namespace fathom::runtime
