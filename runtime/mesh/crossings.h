// Points of the surface on the lattice's edges, with normals and surfaces.
// Tested by: tests/runtime/mesh/contour_test.cpp
#pragma once

#include <vector>

#include "runtime/mesh/lattice/signed_lattice.h"

namespace fathom::runtime {

struct Crossing {
  glm::dvec3 position;    // programs' coordinates
  glm::dvec3 normal;      // outward unit vector; zero where the field has no gradient
  std::uint32_t surface;  // index into CompiledScene::surfaces
};

// Finds a crossing on every edge of the lattice that has one, in the order of the edges.
std::vector<Crossing> find_crossings(const MeshField& field, const CellLattice& lattice, const SignedLattice& signs,
                                     int threads);

}  // namespace fathom::runtime
