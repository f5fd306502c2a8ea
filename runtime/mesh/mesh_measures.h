// Measures of a closed mesh: its bodies and hollows, and places at which it meets itself.
//
//     const MeshMeasures measures = measure(mesh);
//     const std::size_t crossings = count_crossings(mesh, threads), folds = count_folds(mesh);
//
// Tested by: tests/runtime/mesh/mesh_measures_test.cpp
#pragma once

#include <cstddef>

#include "runtime/mesh/mesh_sets.h"

namespace fathom::runtime {

// A connected surface is a body's outside if it encloses a positive volume, and else a hollow's.
struct MeshMeasures {
  std::size_t bodies = 0, hollows = 0;
  double volume = 0, area = 0;  // scene units
};
MeshMeasures measure(const TriangleMesh& mesh);

// Returns the volume of each connected surface at the least of its vertices, and 0 at all others.
std::vector<double> surface_volumes(const TriangleMesh& mesh, DisjointSets& connected);

// Returns the number of pairs of triangles that cut each other, of the coordinates rounded to float. Triangles that
// only touch do not count. The same for any number of threads.
std::size_t count_crossings(const TriangleMesh& mesh, int threads);

// Returns the number of edges whose two triangles lie turned over on each other: their normals are more than 177
// degrees apart.
std::size_t count_folds(const TriangleMesh& mesh);

}  // namespace fathom::runtime
