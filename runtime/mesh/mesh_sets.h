// Connected parts of a mesh.
// Tested by: tests/runtime/mesh/files/mesh_file_test.cpp, tests/runtime/mesh/mesh_measures_test.cpp
#pragma once

#include <span>
#include <vector>

#include "runtime/mesh/lattice/disjoint_sets.h"
#include "runtime/mesh/mesh.h"

namespace fathom::runtime {

// Returns the sets of vertices that triangles connect.
inline DisjointSets connected_vertices(const TriangleMesh& mesh) {
  DisjointSets sets(mesh.vertices.size());
  for (const Triangle& triangle : mesh.triangles) {
    for (const std::size_t i : {1u, 2u}) sets.join(triangle.vertices[0], triangle.vertices[i]);
  }
  return sets;
}

// The vertices of some triangles, numbered from 0.
class PartVertices {
 public:
  PartVertices(const TriangleMesh& mesh, std::span<const std::uint32_t> triangles) : numbers_(mesh.vertices.size()) {
    for (const std::uint32_t t : triangles) {
      for (const std::uint32_t v : mesh.triangles[t].vertices) numbers_[v] = 1;
    }
    for (std::uint32_t v = 0; v < numbers_.size(); ++v) {
      if (numbers_[v] == 0) continue;
      numbers_[v] = static_cast<std::uint32_t>(used.size());
      used.push_back(v);
    }
  }
  std::uint32_t number(std::uint32_t vertex) const { return numbers_[vertex]; }

  std::vector<std::uint32_t> used;  // ascending

 private:
  std::vector<std::uint32_t> numbers_;  // [vertex]
};

}  // namespace fathom::runtime
