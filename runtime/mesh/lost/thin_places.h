// Points of the solid and of its outside that the signs on a lattice do not show: the candidates for parts that are
// too thin for its cells.
//
// - An edge whose ends have one sign may cross the surface twice. Zero-free balls around its points cover it, or a
//   point of the other side is found between them.
// - A finer lattice in each cell shows values that differ from those which the corners let expect.
// - A cell that may hold the surface, with no crossed cell beside it, is searched along the gradient.
//
// Tested by: tests/runtime/mesh/lost_parts_test.cpp
#pragma once

#include <vector>

#include "runtime/mesh/lattice/signed_lattice.h"
#include "runtime/mesh/lost/field_probe.h"

namespace fathom::runtime {

struct ThinPlace {
  std::uint32_t cell;  // a cell near the point
  glm::dvec3 place;    // programs' coordinates
  Side side;           // of the point, not Unknown
  bool on_edge;        // the point lies between two corners of the other side that the mesh connects
  bool is_between_pieces = false;  // of the mesh, and on their side
};

// Returns candidates in the order of cells. The same for any number of threads.
std::vector<ThinPlace> find_thin_places(const MeshField& field, const CellLattice& lattice,
                                        const SignedLattice& signs, int threads);

// True if a cell with signs of both kinds is within `reach` cells.
bool is_near_crossed(const SignedLattice& signs, std::uint32_t cell, int reach);

}  // namespace fathom::runtime
