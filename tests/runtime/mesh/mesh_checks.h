// Checks of meshes that share no code with the product: manifold edges and fans, volumes, distances.
#pragma once

#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "runtime/mesh/make_mesh.h"
#include "runtime/mesh/mesh.h"
#include "runtime/mesh/mesh_measures.h"
#include "tests/support/catch.h"

namespace fathom::test {

struct MeshFaults {
  std::size_t edges = 0;     // edges without exactly one triangle on each side
  std::size_t fans = 0;      // vertices whose triangles are not one fan
  std::size_t unused = 0;    // vertices without a triangle
  std::size_t repeated = 0;  // triangles with a vertex twice

  bool operator==(const MeshFaults&) const = default;
};

// Counts the places at which a mesh is not a closed, consistently oriented manifold.
inline MeshFaults faults_of(const runtime::TriangleMesh& mesh) {
  MeshFaults faults;
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  std::vector<std::map<std::uint32_t, std::uint32_t>> next(mesh.vertices.size());  // around a vertex
  for (const runtime::Triangle& triangle : mesh.triangles) {
    const auto& v = triangle.vertices;
    faults.repeated += v[0] == v[1] || v[1] == v[2] || v[2] == v[0];
    for (std::size_t i = 0; i < 3; ++i) {
      ++edges[{v[i], v[(i + 1) % 3]}];
      next[v[i]][v[(i + 1) % 3]] = v[(i + 2) % 3];
    }
  }
  for (const auto& [edge, count] : edges) {
    const auto back = edges.find({edge.second, edge.first});
    faults.edges += count != 1 || back == edges.end() || back->second != 1;
  }
  for (const auto& fan : next) {
    if (fan.empty()) {
      ++faults.unused;
      continue;
    }
    std::size_t length = 0;
    std::uint32_t at = fan.begin()->first;
    do {
      const auto after = fan.find(at);
      if (after == fan.end()) break;
      at = after->second;
      ++length;
    } while (at != fan.begin()->first && length <= fan.size());
    faults.fans += length != fan.size();
  }
  return faults;
}

// Returns the largest distance of points of the mesh, on a grid in each triangle, by a closed form.
inline double largest_distance(const runtime::TriangleMesh& mesh, const std::function<double(glm::dvec3)>& distance) {
  constexpr int kGrid = 12;
  double most = 0;
  for (const runtime::Triangle& triangle : mesh.triangles) {
    const auto p = mesh.corners(triangle);
    for (int i = 0; i <= kGrid; ++i) {
      for (int j = 0; i + j <= kGrid; ++j) {
        const double u = static_cast<double>(i) / kGrid, v = static_cast<double>(j) / kGrid;
        most = std::max(most, std::abs(distance((1 - u - v) * p[0] + u * p[1] + v * p[2])));
      }
    }
  }
  return most;
}

// Makes a mesh of a bounded scene with `resolution` cells along its longest side.
inline runtime::MeshResult meshed(const compiler::CompiledScene& scene, double resolution, bool simplifies = true,
                                  int threads = 2) {
  runtime::MeshOptions options;
  options.tolerance = runtime::tolerance_of(scene.bound, resolution);
  options.deviation = runtime::fine_deviation(options.tolerance);
  options.simplifies = simplifies;
  options.memory = 8e9;
  options.threads = threads;
  return runtime::make_mesh(scene, scene.bound, options);
}

}  // namespace fathom::test
