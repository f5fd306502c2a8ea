// Parts of the scene that a lattice loses because they are thinner than its cells.
//
// A cell that may hold the surface, but has no corner on the other side and no crossed cell within two cells, is
// searched along
// the field's gradient. A point on the other side is a lost part: of the solid if the corners are outside, of a gap
// if they are inside. Tested by: tests/runtime/mesh/lost_parts_test.cpp
#pragma once

#include <cstddef>
#include <vector>

#include "runtime/mesh/signed_lattice.h"

namespace fathom::runtime {

// The lost parts of one surface.
struct LostPart {
  std::uint32_t surface;  // index into CompiledScene::surfaces
  bool is_gap;            // empty space within the solid, and not a part of the solid
  glm::dvec3 place;       // the thinnest place that was found, programs' coordinates
  double thickness;       // there at least, scene units; at most two cells
  std::size_t cells;      // number of cells with lost parts
};

// Returns one entry per surface and kind, in the order of surfaces.
std::vector<LostPart> find_lost_parts(const MeshField& field, const CellLattice& lattice, const SignedLattice& signs,
                                      int threads);

}  // namespace fathom::runtime
