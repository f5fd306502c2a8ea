// Edge collapses in a closed mesh (runtime/mesh/simplify.h): the mesh with its adjacency, and the queue of collapses
// of one part of it.
// Tested by: tests/runtime/mesh/simplify_test.cpp
#pragma once

#include <cstdint>
#include <limits>
#include <queue>
#include <span>
#include <utility>
#include <vector>

#include "runtime/mesh/contour.h"
#include "runtime/mesh/distance_proof.h"

namespace fathom::runtime {

struct SimplifyOptions {
  double tolerance = 0;  // max distance of any point from the surface, scene units
  double deviation = 0;  // max distance of samples from the surface, scene units
  double block = 0;      // edge of the blocks that threads simplify one by one, scene units
  int threads = 1;
  std::span<const std::uint32_t> material_of;  // [surface]
};

// A mesh with the triangles around each vertex. A dead triangle has the surface kDead.
struct LinkedMesh {
  static constexpr std::uint32_t kDead = 0xffffffff;

  explicit LinkedMesh(Contour& contour);

  bool contains(std::uint32_t triangle, std::uint32_t vertex) const {
    const auto& v = triangles[triangle].vertices;
    return v[0] == vertex || v[1] == vertex || v[2] == vertex;
  }
  std::array<glm::dvec3, 3> corners(std::uint32_t triangle) const {
    const auto& v = triangles[triangle].vertices;
    return {vertices[v[0]], vertices[v[1]], vertices[v[2]]};
  }
  // Returns the two triangles at an edge.
  std::array<std::uint32_t, 2> sides_of(std::uint32_t u, std::uint32_t v) const;
  // Replaces `out` by the neighbours of a vertex, ascending.
  void find_neighbours(std::uint32_t vertex, std::vector<std::uint32_t>& out) const;
  // Moves u to `place` and removes v with the triangles at the edge.
  void merge(std::uint32_t u, std::uint32_t v, glm::dvec3 place);
  // Removes dead vertices and triangles.
  void compact();

  std::vector<glm::dvec3>& vertices;
  std::vector<Triangle>& triangles;
  std::vector<Quadric>& quadrics;
  std::vector<std::vector<std::uint32_t>> around;  // [vertex] its triangles; empty if the vertex is dead
  std::vector<std::uint32_t> versions;             // [vertex] number of its changes
};

// Collapses edges of a part of the mesh, the cheapest first.
class EdgeCollapser {
 public:
  EdgeCollapser(LinkedMesh& mesh, const MeshField& field, const SimplifyOptions& options)
      : mesh_(mesh), options_(options), proof_(field) {}

  // Collapses edges among `vertices`. If `block_of` is not empty, only edges whose triangles have all their vertices
  // in one block.
  void run(std::span<const std::uint32_t> vertices, std::span<const std::uint32_t> block_of);

 private:
  struct Candidate {
    double cost;
    std::uint32_t u, v;
    std::uint32_t version;  // sum of the ends' versions

    bool operator<(const Candidate& other) const {  // the least cost is on top
      if (cost != other.cost) return cost > other.cost;
      return u != other.u ? u > other.u : v > other.v;
    }
  };
  // Kinds of vertices: inside the part of one material, on the border of two, or where more borders meet.
  enum class Kind { Inner, Border, Junction };
  // A place for the vertex that replaces two, with the sum of squared distances to their planes.
  struct Target {
    glm::dvec3 place;
    double error;
  };
  // The place of least error and both ends of the edge, the best first.
  using Targets = std::array<Target, 3>;

  std::uint32_t material(std::uint32_t triangle) const {
    return options_.material_of[mesh_.triangles[triangle].surface];
  }
  bool is_border_edge(std::uint32_t u, std::uint32_t v) const;
  Kind kind_of(std::uint32_t u) const;
  bool is_within_block(std::uint32_t u) const;
  Targets targets(std::uint32_t u, std::uint32_t v) const;
  void push_edges(std::uint32_t u, bool only_upward);
  bool keeps_manifold(std::uint32_t u, std::uint32_t v);
  bool keeps_borders(std::uint32_t u, std::uint32_t v, Targets& targets) const;
  bool add_moved(std::uint32_t u, std::uint32_t v, glm::dvec3 place);
  bool is_proved(std::uint32_t u, std::uint32_t v, glm::dvec3 place);
  void collapse(std::uint32_t u, std::uint32_t v);

  LinkedMesh& mesh_;
  const SimplifyOptions& options_;
  DistanceProof proof_;
  std::span<const std::uint32_t> block_of_;
  std::priority_queue<Candidate> queue_;
  std::vector<std::uint32_t> near_u_, near_v_, common_;
};

}  // namespace fathom::runtime
