#include "runtime/mesh/mesh_measures.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <unordered_map>

#include "compiler/geometry/box_tree.h"
#include "vm/program/parallel_for.h"

namespace fathom::runtime {
namespace {

using Corners = std::array<glm::dvec3, 3>;

// Sign of the volume of a tetrahedron; 0 if rounding may decide it.
int side_of(glm::dvec3 a, glm::dvec3 b, glm::dvec3 c, glm::dvec3 p) {
  const glm::dvec3 u = b - a, v = c - a, w = p - a;
  const double volume = glm::dot(glm::cross(u, v), w);
  constexpr double kRounding = 0x1p-48;
  const double error = kRounding * glm::length(u) * glm::length(v) * glm::length(w);
  return volume > error ? 1 : volume < -error ? -1 : 0;
}

bool cuts(glm::dvec3 p, glm::dvec3 q, const Corners& t) {
  if (side_of(t[0], t[1], t[2], p) * side_of(t[0], t[1], t[2], q) >= 0) return false;
  const int side = side_of(p, q, t[0], t[1]);
  return side != 0 && side_of(p, q, t[1], t[2]) == side && side_of(p, q, t[2], t[0]) == side;
}

// Corners of a triangle, rounded as files hold them.
Corners rounded_corners(const TriangleMesh& mesh, std::size_t t) {
  Corners corners = mesh.corners(mesh.triangles[t]);
  for (glm::dvec3& corner : corners) corner = glm::dvec3(glm::vec3(corner));
  return corners;
}

// True if an edge of triangle `t` cuts `u`. Edges with an end in common with `u` only touch it.
bool has_cutting_edge(const TriangleMesh& mesh, std::size_t t, std::size_t u) {
  const auto& from = mesh.triangles[t].vertices;
  const auto& others = mesh.triangles[u].vertices;
  const auto is_shared = [&](std::uint32_t v) { return v == others[0] || v == others[1] || v == others[2]; };
  const Corners p = rounded_corners(mesh, t), q = rounded_corners(mesh, u);
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t next = (i + 1) % 3;
    if (!is_shared(from[i]) && !is_shared(from[next]) && cuts(p[i], p[next], q)) return true;
  }
  return false;
}

}  // namespace

std::vector<double> surface_volumes(const TriangleMesh& mesh, DisjointSets& connected) {
  std::vector<double> volumes(mesh.vertices.size());
  for (const Triangle& triangle : mesh.triangles) {
    const auto corners = mesh.corners(triangle);
    const std::uint32_t root = connected.root(triangle.vertices[0]);
    // Relative to a point of the surface, so that small surfaces far from zero keep their digits.
    const glm::dvec3 from = mesh.vertices[root];
    volumes[root] += glm::dot(corners[0] - from, glm::cross(corners[1] - from, corners[2] - from)) / 6;
  }
  return volumes;
}

MeshMeasures measure(const TriangleMesh& mesh) {
  MeshMeasures measures;
  DisjointSets sets = connected_vertices(mesh);
  const std::vector<double> volumes = surface_volumes(mesh, sets);
  for (const Triangle& triangle : mesh.triangles)
    measures.area += 0.5 * glm::length(area_normal(mesh.corners(triangle)));
  for (std::uint32_t v = 0; v < volumes.size(); ++v) {
    measures.volume += volumes[v];
    if (sets.root(v) == v) ++(volumes[v] > 0 ? measures.bodies : measures.hollows);
  }
  return measures;
}

std::size_t count_crossings(const TriangleMesh& mesh, int threads) {
  std::vector<compiler::Box> boxes;  // [triangle]
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    compiler::Box box;
    for (const glm::dvec3& corner : rounded_corners(mesh, t)) box = unite(box, {corner, corner});
    boxes.push_back(box);
  }
  const compiler::BoxTree tree(boxes);
  constexpr std::size_t kBatch = 256;
  const std::size_t count = mesh.triangles.size(), batches = (count + kBatch - 1) / kBatch;
  std::vector<std::size_t> found(batches);
  parallel_for(
      threads, batches, [] { return std::vector<std::uint32_t>(); },
      [&](std::vector<std::uint32_t>& near, std::size_t batch) {
        for (std::size_t t = batch * kBatch; t < std::min(count, (batch + 1) * kBatch); ++t) {
          tree.find(boxes[t], near);
          for (const std::uint32_t u : near) {
            found[batch] += u > t && (has_cutting_edge(mesh, t, u) || has_cutting_edge(mesh, u, t));
          }
        }
      });
  return std::accumulate(found.begin(), found.end(), std::size_t{0});
}

std::size_t count_folds(const TriangleMesh& mesh) {
  constexpr double kTurnedOver = -0.9986;                 // cosine of 177 degrees
  std::unordered_map<std::uint64_t, glm::dvec3> normals;  // by edge, of the triangle on its one side
  std::size_t folds = 0;
  for (const Triangle& triangle : mesh.triangles) {
    const glm::dvec3 area = area_normal(mesh.corners(triangle));
    const double length = glm::length(area);
    const glm::dvec3 normal = length > 0 ? area / length : glm::dvec3(0);
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint64_t u = triangle.vertices[i], v = triangle.vertices[(i + 1) % 3];
      const auto [at, is_new] = normals.try_emplace(std::min(u, v) << 32 | std::max(u, v), normal);
      if (is_new) continue;
      folds += glm::dot(at->second, normal) < kTurnedOver;
      normals.erase(at);
    }
  }
  return folds;
}

}  // namespace fathom::runtime
