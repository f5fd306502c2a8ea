#include "runtime/mesh/simplify.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <queue>

#include "runtime/mesh/distance_proof.h"

namespace fathom::runtime {
namespace {

// Share of an edge's length that its collapse costs, so that flat parts lose their shortest edges first.
constexpr double kLengthCost = 1e-4;
// Eigenvalues below this share of the largest count as zero.
constexpr double kFreeShare = 1e-5;
// Min cosine between the normals of a triangle before and after a collapse.
constexpr double kMinTurn = 0.3;
// Min height of a triangle over its longest edge, as a share of that edge.
constexpr double kMinHeight = 1e-3;
// Max root mean square of the distances from a vertex to the tangent planes that it stands for, as a share of the
// tolerance.
constexpr double kMaxPlaneShare = 0.5;
constexpr std::size_t kMaxTriangles = 28;  // around a vertex

class Simplifier {
 public:
  Simplifier(const MeshField& field, Contour& contour, const SimplifyOptions& options)
      : options_(options),
        vertices_(contour.mesh.vertices),
        triangles_(contour.mesh.triangles),
        quadrics_(contour.quadrics),
        contour_(contour),
        proof_(field) {}

  void run() {
    link_triangles();
    add_border_planes();
    for (std::uint32_t u = 0; u < vertices_.size(); ++u) push_edges(u, true);
    while (!queue_.empty()) {
      const Candidate next = queue_.top();
      queue_.pop();
      if (next.version != versions_[next.u] + versions_[next.v] || !is_alive_[next.u] || !is_alive_[next.v]) continue;
      collapse(next.u, next.v);
    }
    compact();
  }

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

  void link_triangles() {
    around_.resize(vertices_.size());
    is_alive_.assign(vertices_.size(), 1);
    versions_.assign(vertices_.size(), 0);
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
      for (const std::uint32_t v : triangles_[t].vertices) around_[v].push_back(t);
    }
  }

  std::uint32_t material(std::uint32_t triangle) const { return options_.material_of[triangles_[triangle].surface]; }
  bool contains(std::uint32_t triangle, std::uint32_t vertex) const {
    const auto& v = triangles_[triangle].vertices;
    return v[0] == vertex || v[1] == vertex || v[2] == vertex;
  }
  // Returns the two triangles at an edge.
  std::array<std::uint32_t, 2> sides_of(std::uint32_t u, std::uint32_t v) const {
    std::array<std::uint32_t, 2> sides{};
    std::size_t count = 0;
    for (const std::uint32_t t : around_[u]) {
      if (contains(t, v) && count < 2) sides[count++] = t;
    }
    return sides;
  }
  bool is_border_edge(std::uint32_t u, std::uint32_t v) const {
    const auto sides = sides_of(u, v);
    return material(sides[0]) != material(sides[1]);
  }

  std::vector<std::uint32_t>& neighbours(std::uint32_t u, std::vector<std::uint32_t>& out) const {
    out.clear();
    for (const std::uint32_t t : around_[u]) {
      for (const std::uint32_t v : triangles_[t].vertices) {
        if (v != u) out.push_back(v);
      }
    }
    std::sort(out.begin(), out.end());
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
  }

  Kind kind_of(std::uint32_t u) const {
    const std::uint32_t first = material(around_[u].front());
    const bool mixed = std::any_of(around_[u].begin(), around_[u].end(), [&](std::uint32_t t) { return material(t) != first; });
    if (!mixed) return Kind::Inner;
    int borders = 0;
    for (const std::uint32_t t : around_[u]) {
      // Each edge at u is the one after u in exactly one of its triangles.
      const auto& v = triangles_[t].vertices;
      const std::uint32_t after = v[0] == u ? v[1] : v[1] == u ? v[2] : v[0];
      borders += is_border_edge(u, after);
    }
    return borders == 2 ? Kind::Border : Kind::Junction;
  }

  // Adds planes through the borders of materials and across the surface, which keep the borders in their place.
  void add_border_planes() {
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
      for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t u = triangles_[t].vertices[i], v = triangles_[t].vertices[(i + 1) % 3];
        if (!is_border_edge(u, v)) continue;
        const glm::dvec3 across = glm::cross(vertices_[v] - vertices_[u], normal_of(contour_.mesh.corners(triangles_[t])));
        const double length = glm::length(across);
        if (!(length > 0)) continue;
        for (const std::uint32_t end : {u, v}) quadrics_[end].add_plane(across / length, vertices_[u]);
      }
    }
  }

  static glm::dvec3 normal_of(const std::array<glm::dvec3, 3>& corners) {
    const glm::dvec3 normal = area_normal(corners);
    const double length = glm::length(normal);
    return length > 0 ? normal / length : glm::dvec3(0);
  }

  // Returns the place of the vertex that replaces u and v, and its cost.
  std::pair<glm::dvec3, double> target(std::uint32_t u, std::uint32_t v) const {
    Quadric sum = quadrics_[u];
    sum += quadrics_[v];
    const glm::dvec3 a = vertices_[u], b = vertices_[v], middle = 0.5 * (a + b);
    const double square = glm::dot(b - a, b - a);
    glm::dvec3 best = minimise(sum, middle, kFreeShare);
    if (!(glm::dot(best - middle, best - middle) <= 2 * square)) best = middle;
    double least = sum.at(best);
    for (const glm::dvec3& other : {a, b}) {
      const double error = sum.at(other);
      if (error < least) least = error, best = other;
    }
    return {best, least + kLengthCost * square};
  }

  void push_edge(std::uint32_t u, std::uint32_t v) {
    queue_.push({target(u, v).second, std::min(u, v), std::max(u, v), versions_[u] + versions_[v]});
  }
  void push_edges(std::uint32_t u, bool only_upward) {
    for (const std::uint32_t v : neighbours(u, near_u_)) {
      if (!only_upward || v > u) push_edge(u, v);
    }
  }

  // True if the collapse keeps the mesh a closed manifold: the ends have two common neighbours and no more, and each
  // of these keeps three neighbours.
  bool keeps_manifold(std::uint32_t u, std::uint32_t v) {
    neighbours(u, near_u_);
    neighbours(v, near_v_);
    common_.clear();
    std::set_intersection(near_u_.begin(), near_u_.end(), near_v_.begin(), near_v_.end(), std::back_inserter(common_));
    if (common_.size() != 2 || around_[u].size() + around_[v].size() > kMaxTriangles + 4) return false;
    return around_[common_[0]].size() > 3 && around_[common_[1]].size() > 3;
  }

  // Sets `place` to where borders of materials allow the collapse to go. Returns false if nowhere.
  bool keeps_borders(std::uint32_t u, std::uint32_t v, glm::dvec3& place) const {
    const Kind ku = kind_of(u), kv = kind_of(v);
    if (ku == Kind::Inner && kv == Kind::Inner) return true;
    if (ku == Kind::Inner || kv == Kind::Inner) {
      place = ku == Kind::Inner ? vertices_[v] : vertices_[u];
      return true;
    }
    if (!is_border_edge(u, v) || (ku == Kind::Junction && kv == Kind::Junction)) return false;
    if (ku == Kind::Junction) place = vertices_[u];
    if (kv == Kind::Junction) place = vertices_[v];
    return true;
  }

  // Adds the triangles at `u`, except those at `v`, with `u` moved to `place`. Returns false if one turns over or has
  // next to no height.
  bool add_moved(std::uint32_t u, std::uint32_t v, glm::dvec3 place) {
    for (const std::uint32_t t : around_[u]) {
      if (contains(t, v)) continue;
      const std::array<glm::dvec3, 3> before = contour_.mesh.corners(triangles_[t]);
      std::array<glm::dvec3, 3> after = before;
      for (std::size_t i = 0; i < 3; ++i) {
        if (triangles_[t].vertices[i] == u) after[i] = place;
      }
      if (glm::dot(normal_of(before), normal_of(after)) < kMinTurn) return false;
      double longest = 0;
      for (std::size_t i = 0; i < 3; ++i) longest = std::max(longest, glm::distance(after[i], after[(i + 1) % 3]));
      if (glm::length(area_normal(after)) < kMinHeight * longest * longest) return false;
      proof_.add(after);
    }
    return true;
  }

  void collapse(std::uint32_t u, std::uint32_t v) {
    if (!keeps_manifold(u, v)) return;
    auto [place, cost] = target(u, v);
    if (!keeps_borders(u, v, place)) return;
    Quadric sum = quadrics_[u];
    sum += quadrics_[v];
    const double most = kMaxPlaneShare * options_.tolerance;
    if (sum.at(place) > most * most * std::max(1.0, sum.weight)) return;
    proof_.clear();
    if (!add_moved(u, v, place) || !add_moved(v, u, place) || !proof_.holds(options_.tolerance)) return;
    merge(u, v, place, sum);
  }

  void merge(std::uint32_t u, std::uint32_t v, glm::dvec3 place, const Quadric& sum) {
    for (const std::uint32_t t : sides_of(u, v)) {
      for (const std::uint32_t w : triangles_[t].vertices) std::erase(around_[w], t);
      triangles_[t].surface = kDead;
    }
    for (const std::uint32_t t : around_[v]) {
      for (std::uint32_t& w : triangles_[t].vertices) {
        if (w == v) w = u;
      }
      around_[u].push_back(t);
    }
    around_[v] = {};
    is_alive_[v] = 0;
    vertices_[u] = place;
    quadrics_[u] = sum;
    ++versions_[u];
    push_edges(u, false);
  }

  // Removes dead vertices and triangles.
  void compact() {
    std::vector<std::uint32_t> number(vertices_.size());
    std::uint32_t count = 0;
    for (std::uint32_t v = 0; v < vertices_.size(); ++v) {
      if (!is_alive_[v]) continue;
      number[v] = count;
      quadrics_[count] = quadrics_[v];
      vertices_[count++] = vertices_[v];
    }
    vertices_.resize(count);
    quadrics_.resize(count);
    std::erase_if(triangles_, [](const Triangle& triangle) { return triangle.surface == kDead; });
    for (Triangle& triangle : triangles_) {
      for (std::uint32_t& v : triangle.vertices) v = number[v];
    }
  }

  static constexpr std::uint32_t kDead = 0xffffffff;  // surface of a removed triangle

  const SimplifyOptions& options_;
  std::vector<glm::dvec3>& vertices_;
  std::vector<Triangle>& triangles_;
  std::vector<Quadric>& quadrics_;
  Contour& contour_;
  DistanceProof proof_;
  std::vector<std::vector<std::uint32_t>> around_;  // [vertex] its triangles
  std::vector<std::uint8_t> is_alive_;              // [vertex]
  std::vector<std::uint32_t> versions_;             // [vertex] number of its changes
  std::priority_queue<Candidate> queue_;
  std::vector<std::uint32_t> near_u_, near_v_, common_;
};

}  // namespace

void simplify(const MeshField& field, Contour& contour, const SimplifyOptions& options) {
  Simplifier(field, contour, options).run();
}

}  // namespace fathom::runtime
