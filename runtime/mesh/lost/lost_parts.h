// Parts of the scene that a mesh does not show as they are, because they are thinner than its cells: parts and gaps
// that it lacks, and parts and gaps that are in pieces in the mesh.
//
// Sharp edges and tips may fall short by up to two cells and are not lost parts, unless pieces of them are apart.
// Tested by: tests/runtime/mesh/lost_parts_test.cpp
#pragma once

#include <cstddef>
#include <vector>

#include "runtime/mesh/lattice/signed_lattice.h"

namespace fathom::runtime {

// The lost parts of one surface and kind.
struct LostPart {
  std::uint32_t surface;  // index into CompiledScene::surfaces
  std::uint32_t other;    // the surface on the other side of a gap, or `surface`
  bool is_gap;            // empty space within or between solids, and not a part of the solid
  bool is_torn;           // the mesh has pieces of it that are apart
  bool tapers;  // every place that was found is thinner nearby, as wedges and tips are: finer cells lose some, too
  // Programs' coordinates: the thinnest place that was found, or the thickest if the part tapers.
  glm::dvec3 place;
  double thickness;    // there, scene units; at most four cells
  std::size_t places;  // number of places that were found
};

struct LostParts {
  std::vector<LostPart> parts;  // in the order of surfaces, one per kind
  std::size_t islands = 0;      // number of bodies of the mesh that are parts of another
};

LostParts find_lost_parts(const MeshField& field, const CellLattice& lattice, const SignedLattice& signs,
                          int threads);

}  // namespace fathom::runtime
