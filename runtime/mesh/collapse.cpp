#include "runtime/mesh/collapse.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <iterator>

namespace fathom::runtime {
namespace {

// Share of an edge's squared length that its collapse costs, so that flat parts lose their shortest edges first.
constexpr double kLengthCost = 1e-4;
// Share of the planes' weight that pulls the new vertex to the middle of the edge, where the planes leave it free.
constexpr double kPullShare = 1e-6;
// Min cosine between the normals of a triangle before and after a collapse.
constexpr double kMinTurn = 0.3;
// Min height of a triangle over its longest edge, as a share of that edge.
constexpr double kMinHeight = 1e-3;
constexpr std::size_t kMaxTriangles = 32;  // around both ends of an edge

glm::dvec3 unit_normal(const std::array<glm::dvec3, 3>& corners) {
  const glm::dvec3 normal = area_normal(corners);
  const double length = glm::length(normal);
  return length > 0 ? normal / length : glm::dvec3(0);
}

// Returns the point of least error, with a pull to `middle`. Solves three equations by Cramer's rule.
glm::dvec3 pulled_minimum(const Quadric& q, glm::dvec3 middle) {
  const double pull = kPullShare * q.trace();
  const double xx = q.a[0] + pull, xy = q.a[1], xz = q.a[2], yy = q.a[3] + pull, yz = q.a[4], zz = q.a[5] + pull;
  const glm::dvec3 right = q.b - q.times(middle);  // relative to the middle
  const double c0 = yy * zz - yz * yz, c1 = xz * yz - xy * zz, c2 = xy * yz - xz * yy;
  const double determinant = xx * c0 + xy * c1 + xz * c2;
  if (!(determinant > 0)) return middle;
  const double c3 = xx * zz - xz * xz, c4 = xy * xz - xx * yz, c5 = xx * yy - xy * xy;
  return middle + glm::dvec3(c0 * right.x + c1 * right.y + c2 * right.z, c1 * right.x + c3 * right.y + c4 * right.z,
                             c2 * right.x + c4 * right.y + c5 * right.z) /
                      determinant;
}

}  // namespace

LinkedMesh::LinkedMesh(Contour& contour)
    : vertices(contour.mesh.vertices),
      triangles(contour.mesh.triangles),
      quadrics(contour.quadrics),
      around(vertices.size()),
      versions(vertices.size(), 0) {
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    for (const std::uint32_t v : triangles[t].vertices) around[v].push_back(t);
  }
}

std::array<std::uint32_t, 2> LinkedMesh::sides_of(std::uint32_t u, std::uint32_t v) const {
  std::array<std::uint32_t, 2> sides{};
  std::size_t count = 0;
  for (const std::uint32_t t : around[u]) {
    if (contains(t, v) && count < 2) sides[count++] = t;
  }
  return sides;
}

void LinkedMesh::find_neighbours(std::uint32_t vertex, std::vector<std::uint32_t>& out) const {
  out.clear();
  for (const std::uint32_t t : around[vertex]) {
    // Each neighbour is the one after the vertex in exactly one triangle.
    const auto& v = triangles[t].vertices;
    out.push_back(v[0] == vertex ? v[1] : v[1] == vertex ? v[2] : v[0]);
  }
  std::sort(out.begin(), out.end());
}

void LinkedMesh::merge(std::uint32_t u, std::uint32_t v, glm::dvec3 place) {
  for (const std::uint32_t t : sides_of(u, v)) {
    for (const std::uint32_t w : triangles[t].vertices) std::erase(around[w], t);
    triangles[t].surface = kDead;
  }
  for (const std::uint32_t t : around[v]) {
    for (std::uint32_t& w : triangles[t].vertices) {
      if (w == v) w = u;
    }
    around[u].push_back(t);
  }
  around[v] = {};
  vertices[u] = place;
  quadrics[u] += quadrics[v];
  ++versions[u];
}

void LinkedMesh::compact() {
  std::vector<std::uint32_t> number(vertices.size());
  std::uint32_t count = 0;
  for (std::uint32_t v = 0; v < vertices.size(); ++v) {
    if (around[v].empty()) continue;
    number[v] = count;
    quadrics[count] = quadrics[v];
    vertices[count++] = vertices[v];
  }
  vertices.resize(count);
  quadrics.resize(count);
  std::erase_if(triangles, [](const Triangle& triangle) { return triangle.surface == kDead; });
  for (Triangle& triangle : triangles) {
    for (std::uint32_t& v : triangle.vertices) v = number[v];
  }
}

void EdgeCollapser::run(std::span<const std::uint32_t> vertices, std::span<const std::uint32_t> block_of) {
  block_of_ = block_of;
  for (const std::uint32_t u : vertices) {
    if (!mesh_.around[u].empty()) push_edges(u, true);
  }
  while (!queue_.empty()) {
    const Candidate next = queue_.top();
    queue_.pop();
    const bool stale = next.version != mesh_.versions[next.u] + mesh_.versions[next.v];
    if (!stale && !mesh_.around[next.u].empty() && !mesh_.around[next.v].empty()) collapse(next.u, next.v);
  }
}

bool EdgeCollapser::is_border_edge(std::uint32_t u, std::uint32_t v) const {
  const auto sides = mesh_.sides_of(u, v);
  return material(sides[0]) != material(sides[1]);
}

EdgeCollapser::Kind EdgeCollapser::kind_of(std::uint32_t u) const {
  const auto& around = mesh_.around[u];
  const std::uint32_t first = material(around.front());
  if (std::all_of(around.begin(), around.end(), [&](std::uint32_t t) { return material(t) == first; })) {
    return Kind::Inner;
  }
  int borders = 0;
  for (const std::uint32_t t : around) {
    const auto& v = mesh_.triangles[t].vertices;
    borders += is_border_edge(u, v[0] == u ? v[1] : v[1] == u ? v[2] : v[0]);
  }
  return borders == 2 ? Kind::Border : Kind::Junction;
}

// True if all triangles around the vertex are in its block.
bool EdgeCollapser::is_within_block(std::uint32_t u) const {
  if (block_of_.empty()) return true;
  for (const std::uint32_t t : mesh_.around[u]) {
    for (const std::uint32_t v : mesh_.triangles[t].vertices) {
      if (block_of_[v] != block_of_[u]) return false;
    }
  }
  return true;
}

EdgeCollapser::Targets EdgeCollapser::targets(std::uint32_t u, std::uint32_t v) const {
  Quadric sum = mesh_.quadrics[u];
  sum += mesh_.quadrics[v];
  const glm::dvec3 a = mesh_.vertices[u], b = mesh_.vertices[v], middle = 0.5 * (a + b);
  glm::dvec3 best = pulled_minimum(sum, middle);
  if (!(glm::dot(best - middle, best - middle) <= 2 * glm::dot(b - a, b - a))) best = middle;
  Targets found = {{{best, sum.at(best)}, {a, sum.at(a)}, {b, sum.at(b)}}};
  std::stable_sort(found.begin(), found.end(), [](const Target& x, const Target& y) { return x.error < y.error; });
  return found;
}

void EdgeCollapser::push_edges(std::uint32_t u, bool only_upward) {
  if (!is_within_block(u)) return;
  mesh_.find_neighbours(u, near_u_);
  for (const std::uint32_t v : near_u_) {
    if (only_upward && v < u) continue;
    const glm::dvec3 along = mesh_.vertices[v] - mesh_.vertices[u];
    const double cost = targets(u, v).front().error + kLengthCost * glm::dot(along, along);
    queue_.push({cost, std::min(u, v), std::max(u, v), mesh_.versions[u] + mesh_.versions[v]});
  }
}

// True if the collapse keeps the mesh a closed manifold: the ends have two common neighbours and no more, and each of
// these keeps three neighbours.
bool EdgeCollapser::keeps_manifold(std::uint32_t u, std::uint32_t v) {
  if (mesh_.around[u].size() + mesh_.around[v].size() > kMaxTriangles) return false;
  mesh_.find_neighbours(u, near_u_);
  mesh_.find_neighbours(v, near_v_);
  common_.clear();
  std::set_intersection(near_u_.begin(), near_u_.end(), near_v_.begin(), near_v_.end(), std::back_inserter(common_));
  return common_.size() == 2 && mesh_.around[common_[0]].size() > 3 && mesh_.around[common_[1]].size() > 3;
}

// Reduces the targets to those that the borders of materials allow. Returns false if there are none.
bool EdgeCollapser::keeps_borders(std::uint32_t u, std::uint32_t v, Targets& targets) const {
  const Kind ku = kind_of(u), kv = kind_of(v);
  if (ku == Kind::Inner && kv == Kind::Inner) return true;
  if (ku != Kind::Inner && kv != Kind::Inner) {
    if (!is_border_edge(u, v) || (ku == Kind::Junction && kv == Kind::Junction)) return false;
    if (ku == Kind::Border && kv == Kind::Border) return true;
  }
  // The vertex on the border, or at the junction, stays.
  const bool u_stays = kv == Kind::Inner || ku == Kind::Junction;
  const glm::dvec3 place = mesh_.vertices[u_stays ? u : v];
  const auto stays =
      std::find_if(targets.begin(), targets.end(), [&](const Target& to) { return to.place == place; });
  targets.fill(*stays);
  return true;
}

// Adds the triangles at `u`, except those at `v`, with `u` moved to `place`. Returns false if one turns over or has
// next to no height.
bool EdgeCollapser::add_moved(std::uint32_t u, std::uint32_t v, glm::dvec3 place) {
  for (const std::uint32_t t : mesh_.around[u]) {
    if (mesh_.contains(t, v)) continue;
    const std::array<glm::dvec3, 3> before = mesh_.corners(t);
    std::array<glm::dvec3, 3> after = before;
    for (std::size_t i = 0; i < 3; ++i) {
      if (mesh_.triangles[t].vertices[i] == u) after[i] = place;
    }
    if (glm::dot(unit_normal(before), unit_normal(after)) < kMinTurn) return false;
    double longest = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const glm::dvec3 edge = after[(i + 1) % 3] - after[i];
      longest = std::max(longest, glm::dot(edge, edge));
    }
    if (glm::length(area_normal(after)) < kMinHeight * longest) return false;
    proof_.add(after);
  }
  return true;
}

bool EdgeCollapser::is_proved(std::uint32_t u, std::uint32_t v, glm::dvec3 place) {
  proof_.clear();
  return add_moved(u, v, place) && add_moved(v, u, place) && proof_.holds(options_.tolerance, options_.deviation);
}

void EdgeCollapser::collapse(std::uint32_t u, std::uint32_t v) {
  if (!is_within_block(u) || !is_within_block(v) || !keeps_manifold(u, v)) return;
  Targets to = targets(u, v);
  if (!keeps_borders(u, v, to)) return;
  const double weight = mesh_.quadrics[u].weight + mesh_.quadrics[v].weight;
  const double most = options_.deviation * options_.deviation * std::max(1.0, weight);
  for (std::size_t i = 0; i < to.size(); ++i) {
    if (to[i].error > most || (i > 0 && to[i].place == to[i - 1].place)) return;
    if (!is_proved(u, v, to[i].place)) continue;
    mesh_.merge(u, v, to[i].place);
    push_edges(u, false);
    return;
  }
}

}  // namespace fathom::runtime
