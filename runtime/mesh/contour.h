// Dual contouring: a closed manifold mesh with one vertex per piece of the surface in each cell of a lattice, and one
// polygon per edge that crosses the surface.
//
// The pieces of all cells, joined along the arcs on the cells' faces, are a closed surface, whose dual is the mesh.
// Two pieces that share both arcs of a face with diagonal signs would be joined by two edges of the mesh, which an
// indexed mesh does not tell apart. One of the two gets a vertex of its own on the face. Two vertices of a polygon
// that are not neighbours in it lie in cells that share no face, so no other polygon has the same diagonal. Every
// edge of the mesh therefore has exactly two triangles, and every vertex one fan.
//
// Each vertex stays in its cell. A triangle of the polygon around a lattice edge is therefore within a cell's
// diagonal of the surface, which crosses that edge.
//
// Sources: Ju et al., "Dual contouring of Hermite data", 2002; Nielson, "Dual marching cubes", 2004; Schaefer, Ju and
// Warren, "Manifold dual contouring", 2007; Wenger, "Isosurfaces", 2013.
// Tested by: tests/runtime/mesh/contour_test.cpp
#pragma once

#include <vector>

#include "runtime/mesh/crossings.h"
#include "runtime/mesh/mesh.h"
#include "runtime/mesh/qef.h"

namespace fathom::runtime {

struct Contour {
  TriangleMesh mesh;
  std::vector<Quadric> quadrics;  // [vertex] of the tangent planes at the crossings around
  // [vertex] its cell; kNoCell for a vertex on a face.
  static constexpr LatticeKey kNoCell = ~LatticeKey{0};
  std::vector<LatticeKey> cells;
};

// Distance of a vertex from the sides of its cell, as a share of the cell's edge, so that vertices of different cells
// stay different after rounding to float.
inline constexpr double kCellInset = 0x1p-8;
// Returns the part of a cell in which its vertices stay.
compiler::Box inset_box(const CellLattice& lattice, LatticePlace cell);

// Makes the mesh. `crossings` has one entry per edge of `signs`.
Contour contour(const CellLattice& lattice, const SignedLattice& signs, const std::vector<Crossing>& crossings);

}  // namespace fathom::runtime
