#include "runtime/mesh/simplify.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <memory>
#include <numeric>

#include "runtime/mesh/collapse.h"
#include "vm/program/parallel_for.h"

namespace fathom::runtime {
namespace {

// Adds planes through the borders of materials and across the surface, which keep the borders in their place.
void add_border_planes(LinkedMesh& mesh, const SimplifyOptions& options) {
  const auto material = [&](std::uint32_t t) { return options.material_of[mesh.triangles[t].surface]; };
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t u = mesh.triangles[t].vertices[i], v = mesh.triangles[t].vertices[(i + 1) % 3];
      const auto sides = mesh.sides_of(u, v);
      if (material(sides[0]) == material(sides[1])) continue;
      const glm::dvec3 across = glm::cross(mesh.vertices[v] - mesh.vertices[u], area_normal(mesh.corners(t)));
      const double length = glm::length(across);
      if (!(length > 0)) continue;
      for (const std::uint32_t end : {u, v}) mesh.quadrics[end].add_plane(across / length, mesh.vertices[u]);
    }
  }
}

// The vertices of each block.
struct Blocks {
  std::vector<std::uint32_t> block_of;               // [vertex]
  std::vector<std::vector<std::uint32_t>> vertices;  // [block]
};

Blocks find_blocks(const std::vector<glm::dvec3>& vertices, double edge) {
  Blocks blocks;
  KeyMap numbers;
  glm::dvec3 lo(std::numeric_limits<double>::infinity());
  for (const glm::dvec3& v : vertices) lo = glm::min(lo, v);
  for (std::uint32_t v = 0; v < vertices.size(); ++v) {
    const glm::dvec3 at = (vertices[v] - lo) / edge;
    const LatticePlace place{{static_cast<int>(at.x), static_cast<int>(at.y), static_cast<int>(at.z)}};
    const std::uint32_t block = numbers.insert(key_of(place));
    blocks.vertices.resize(numbers.size());
    blocks.vertices[block].push_back(v);
    blocks.block_of.push_back(block);
  }
  return blocks;
}

}  // namespace

void simplify(const MeshField& field, Contour& contour, const SimplifyOptions& options) {
  LinkedMesh mesh(contour);
  add_border_planes(mesh, options);
  const Blocks blocks = find_blocks(mesh.vertices, options.block);
  parallel_for(
      options.threads, blocks.vertices.size(), [&] { return std::make_unique<EdgeCollapser>(mesh, field, options); },
      [&](std::unique_ptr<EdgeCollapser>& collapser, std::size_t block) {
        collapser->run(blocks.vertices[block], blocks.block_of);
      });
  std::vector<std::uint32_t> all(mesh.vertices.size());
  std::iota(all.begin(), all.end(), 0u);
  EdgeCollapser(mesh, field, options).run(all, {});
  mesh.compact();
}

}  // namespace fathom::runtime
