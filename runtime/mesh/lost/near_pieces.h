// Pieces of a mesh that come near each other: where the gap between them is narrowest, the scene may connect them by a
// tip or an edge that all points of the lattice miss.
// Tested by: tests/runtime/mesh/mesh_counts_test.cpp
#pragma once

#include <vector>

#include "runtime/mesh/lost/lattice_labels.h"
#include "runtime/mesh/lost/thin_places.h"
#include "runtime/mesh/lost/thin_region.h"

namespace fathom::runtime {

// Returns points within the solid between pieces of the solid, and points outside of it between pieces of the outside,
// in the order of blocks of cells. If pieces are near in thousands of places, some are looked at.
// The same for any number of threads.
std::vector<ThinPlace> find_narrow_places(const MeshField& field, const CellLattice& lattice,
                                          const SignedLattice& signs, const LatticeLabels& labels, int threads);

}  // namespace fathom::runtime
