// Which parts of a lattice its signs connect: corners of one sign, along edges, across faces, and along the pieces of
// a surface.
// Tested by: tests/runtime/mesh/mesh_counts_test.cpp
#pragma once

#include "runtime/mesh/lattice/disjoint_sets.h"
#include "runtime/mesh/lattice/signed_lattice.h"

namespace fathom::runtime {

// Corners have one label if the mesh connects them within the solid or outside of it: through cells that may hold the
// surface, or along an axis from the utmost corner of some to the next of its sign. No cell on that way holds a zero.
class LatticeLabels {
 public:
  LatticeLabels(const SignedLattice& signs, const CellLattice& lattice);

  std::uint32_t of(std::uint32_t corner) const { return labels_[corner]; }

 private:
  std::vector<std::uint32_t> labels_;  // [corner]
};

}  // namespace fathom::runtime
