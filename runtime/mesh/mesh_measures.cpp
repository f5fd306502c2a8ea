#include "runtime/mesh/mesh_measures.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <unordered_map>

#include "compiler/geometry/box.h"
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

// A tree of boxes over the triangles (Ericson, "Real-time collision detection", 2005, chapter 6): each node halves
// its part of an order of the triangles.
class TriangleTree {
 public:
  explicit TriangleTree(const TriangleMesh& mesh) : mesh_(mesh), order_(mesh.triangles.size()) {
    std::iota(order_.begin(), order_.end(), 0u);
    for (std::uint32_t t = 0; t < order_.size(); ++t) {
      compiler::Box box;
      for (const glm::dvec3& corner : corners(t)) box = unite(box, {corner, corner});
      boxes_.push_back(box);
    }
    std::size_t leaves = 1;
    while (leaves * kLeaf < order_.size()) leaves *= 2;
    nodes_.resize(2 * leaves);
    if (!order_.empty()) build(1, 0, order_.size());
  }

  // Returns the number of triangles after `t` that cut t.
  std::size_t count_after(std::uint32_t t) const { return count_after(t, 1, 0, order_.size()); }

 private:
  static constexpr std::size_t kLeaf = 4;

  Corners corners(std::uint32_t t) const {
    Corners rounded = mesh_.corners(mesh_.triangles[t]);
    for (glm::dvec3& corner : rounded) corner = glm::dvec3(glm::vec3(corner));
    return rounded;
  }

  void build(std::size_t node, std::size_t first, std::size_t last) {
    compiler::Box box;
    for (std::size_t i = first; i < last; ++i) box = unite(box, boxes_[order_[i]]);
    nodes_[node] = box;
    if (2 * node >= nodes_.size()) return;
    const glm::dvec3 size = box.hi - box.lo;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const std::size_t middle = (first + last) / 2;
    std::nth_element(order_.begin() + static_cast<std::ptrdiff_t>(first),
                     order_.begin() + static_cast<std::ptrdiff_t>(middle),
                     order_.begin() + static_cast<std::ptrdiff_t>(last), [&](std::uint32_t a, std::uint32_t b) {
                       const double x = boxes_[a].lo[axis] + boxes_[a].hi[axis];
                       const double y = boxes_[b].lo[axis] + boxes_[b].hi[axis];
                       return x != y ? x < y : a < b;
                     });
    build(2 * node, first, middle);
    build(2 * node + 1, middle, last);
  }

  static bool overlap(const compiler::Box& a, const compiler::Box& b) {
    for (int axis = 0; axis < 3; ++axis) {
      if (a.lo[axis] > b.hi[axis] || b.lo[axis] > a.hi[axis]) return false;
    }
    return true;
  }

  std::size_t count_after(std::uint32_t t, std::size_t node, std::size_t first, std::size_t last) const {
    if (first == last || !overlap(boxes_[t], nodes_[node])) return 0;
    std::size_t count = 0;
    if (2 * node < nodes_.size()) {
      const std::size_t middle = (first + last) / 2;
      return count_after(t, 2 * node, first, middle) + count_after(t, 2 * node + 1, middle, last);
    }
    for (std::size_t i = first; i < last; ++i) {
      count += order_[i] > t && overlap(boxes_[t], boxes_[order_[i]]) && do_cross(t, order_[i]);
    }
    return count;
  }

  // Two triangles cross if an edge of one cuts the other. Edges with an end in common with the other only touch it.
  bool do_cross(std::uint32_t t, std::uint32_t u) const { return has_cutting_edge(t, u) || has_cutting_edge(u, t); }
  bool has_cutting_edge(std::uint32_t t, std::uint32_t u) const {
    const auto& from = mesh_.triangles[t].vertices;
    const auto& others = mesh_.triangles[u].vertices;
    const auto is_shared = [&](std::uint32_t v) { return v == others[0] || v == others[1] || v == others[2]; };
    const Corners p = corners(t), q = corners(u);
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t next = (i + 1) % 3;
      if (!is_shared(from[i]) && !is_shared(from[next]) && cuts(p[i], p[next], q)) return true;
    }
    return false;
  }

  const TriangleMesh& mesh_;
  std::vector<std::uint32_t> order_;
  std::vector<compiler::Box> boxes_;  // [triangle]
  std::vector<compiler::Box> nodes_;  // [node], children of node n: 2 n and 2 n + 1
};

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
  const TriangleTree tree(mesh);
  constexpr std::size_t kBatch = 256;
  const std::size_t count = mesh.triangles.size(), batches = (count + kBatch - 1) / kBatch;
  std::vector<std::size_t> found(batches);
  parallel_for(
      threads, batches, [] { return 0; },
      [&](int, std::size_t batch) {
        for (std::size_t t = batch * kBatch; t < std::min(count, (batch + 1) * kBatch); ++t) {
          found[batch] += tree.count_after(static_cast<std::uint32_t>(t));
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
