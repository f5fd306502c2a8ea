// The cells of a lattice that may contain the surface, found by an octree: a cell is left out only if the field's
// constant proves that it holds no zero.
// Tested by: tests/runtime/mesh/contour_test.cpp
#pragma once

#include <cstddef>
#include <vector>

#include "runtime/mesh/lattice/lattice.h"
#include "runtime/mesh/lattice/mesh_field.h"

namespace fathom::runtime {

struct FoundCells {
  std::vector<LatticeKey> cells;  // in Morton's order; empty if there are too many
  bool too_many = false;
  std::size_t expected = 0;  // number of cells, an estimate if there are too many
};

// Finds the cells. Stops when there are more than `most`.
FoundCells find_cells(const MeshField& field, const CellLattice& lattice, std::size_t most, int threads);

}  // namespace fathom::runtime
