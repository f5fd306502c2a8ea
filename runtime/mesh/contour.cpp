#include "runtime/mesh/contour.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace fathom::runtime {
namespace {

// Eigenvalues below this share of the largest count as zero: creases flatter than some twenty degrees are surfaces.
constexpr double kFlatShare = 0.03;

// Vertices of a cell: the first, and for each edge which of them is its cycle's.
struct CellVertices {
  std::uint32_t first;
  std::uint32_t cycles;  // two bits per edge

  std::uint32_t at(int edge) const { return first + (cycles >> 2 * edge & 3); }
};

class DualContour {
 public:
  DualContour(const CellLattice& lattice, const SignedLattice& signs, const std::vector<Crossing>& crossings)
      : lattice_(lattice), signs_(signs), crossings_(crossings) {}

  Contour run() {
    cells_.resize(signs_.cells().size());
    for (std::uint32_t cell = 0; cell < cells_.size(); ++cell) {
      if (signs_.is_crossed(cell)) add_vertices(cell);
    }
    for (const LatticeKey face : signs_.ambiguous_faces().keys()) split_double_edge(face);
    for (std::uint32_t edge = 0; edge < signs_.edges().size(); ++edge) add_polygon(edge);
    return std::move(result_);
  }

 private:
  // A vertex on a face, which lies on the arc between two edges of the lattice.
  struct ArcVertex {
    std::uint32_t vertex;
    LatticeKey edges[2];
  };

  compiler::Box cell_box(LatticePlace place) const { return inset_box(lattice_, place); }
  LatticeKey edge_key(LatticePlace cell, int edge) const {
    const CubeEdge ends = cube_edge(edge);
    return key_of(cell.corner(ends.lower), ends.axis);
  }
  const Crossing& crossing(LatticePlace cell, int edge) const {
    return crossings_[signs_.edges().find(edge_key(cell, edge))];
  }

  void add_vertices(std::uint32_t cell) {
    const LatticePlace place = place_of(signs_.cells()[cell]);
    const CubeCycles cycles = signs_.cycles(cell);
    CellVertices& vertices = cells_[cell];
    vertices = {static_cast<std::uint32_t>(result_.mesh.vertices.size()), 0};
    for (int edge = 0; edge < kCubeEdges; ++edge) {
      const unsigned cycle = cycles.cycle_of[static_cast<std::size_t>(edge)];
      if (cycle != CubeCycles::kNone) vertices.cycles |= cycle << 2 * edge;
    }
    for (int cycle = 0; cycle < cycles.count; ++cycle) add_vertex(place, cycles, cycle, vertices.first);
  }

  void add_vertex(LatticePlace place, const CubeCycles& cycles, int cycle, std::uint32_t first) {
    Quadric quadric;
    glm::dvec3 sum(0);
    int count = 0;
    const compiler::Box box = cell_box(place);
    const glm::dvec3 middle = 0.5 * (box.lo + box.hi);
    for (int edge = 0; edge < kCubeEdges; ++edge) {
      if (cycles.cycle_of[static_cast<std::size_t>(edge)] != cycle) continue;
      const Crossing& at = crossing(place, edge);
      // Relative to the cell, where no digits cancel.
      if (at.normal != glm::dvec3(0)) quadric.add_plane(at.normal, at.position - middle);
      sum += at.position - middle;
      ++count;
    }
    const compiler::Box local{box.lo - middle, box.hi - middle};
    glm::dvec3 vertex = minimise_within(quadric, sum / static_cast<double>(count), local, kFlatShare) + middle;
    // Pieces of one cell that meet in a point get different vertices.
    for (std::size_t other = first; other < result_.mesh.vertices.size(); ++other) {
      if (glm::distance(result_.mesh.vertices[other], vertex) < 0.5 * kCellInset * lattice_.cell) {
        vertex += 0.25 * (middle - vertex) + kCellInset * (middle - box.lo) * static_cast<double>(cycle);
      }
    }
    append(vertex, quadric, middle, key_of(place));
  }

  // Appends a vertex with its planes, which are relative to `middle`.
  std::uint32_t append(glm::dvec3 vertex, const Quadric& quadric, glm::dvec3 middle,
                       LatticeKey cell = Contour::kNoCell) {
    Quadric moved = quadric;
    const glm::dvec3 turned = quadric.times(middle);
    moved.c += 2 * glm::dot(quadric.b, middle) + glm::dot(middle, turned);
    moved.b += turned;
    result_.mesh.vertices.push_back(vertex);
    result_.quadrics.push_back(moved);
    result_.cells.push_back(cell);
    return static_cast<std::uint32_t>(result_.mesh.vertices.size() - 1);
  }

  // Adds a vertex to the first arc of a face with diagonal signs if both arcs join the same two vertices.
  void split_double_edge(LatticeKey face) {
    const int axis = axis_of(face);
    const LatticePlace upper = place_of(face), lower = upper.moved(axis, -1);
    const std::uint32_t cells[2] = {signs_.cells().find(key_of(lower)), signs_.cells().find(key_of(upper))};
    const auto is_one = [&](std::uint32_t cell, int side) {
      const std::array<int, 4> corners = face_corners(2 * axis + side);
      const CellVertices& vertices = cells_[cell];
      const auto vertex = [&](std::size_t i) { return vertices.at(edge_of(corners[i], corners[(i + 1) % 4])); };
      return vertex(0) == vertex(1) && vertex(1) == vertex(2) && vertex(2) == vertex(3);
    };
    if (!is_one(cells[0], 1) || !is_one(cells[1], 0)) return;
    // The arc that starts at the first edge on which a walk around the upper cell's face leaves the solid.
    const unsigned inside = signs_.inside(cells[1]);
    const std::array<int, 4> corners = face_corners(2 * axis);
    const std::size_t first = inside >> corners[0] & 1 ? 0 : 1;
    const int start = edge_of(corners[first], corners[first + 1]);
    const int end = end_of_arc(inside, 2 * axis, start, signs_.is_open(face));
    ArcVertex arc{0, {edge_key(upper, start), edge_key(upper, end)}};
    const compiler::Box box = cell_box(upper);
    glm::dvec3 vertex = 0.5 * (crossing(upper, start).position + crossing(upper, end).position);
    vertex = glm::clamp(vertex, box.lo, box.hi);
    vertex[axis] = static_cast<double>(lattice_.corner(upper)[axis]);
    Quadric quadric;
    for (const int edge : {start, end}) {
      const Crossing& at = crossing(upper, edge);
      if (at.normal != glm::dvec3(0)) quadric.add_plane(at.normal, at.position - vertex);
    }
    arc.vertex = append(vertex, quadric, vertex);
    arcs_.emplace(face, arc);
  }

  static int edge_of(int a, int b) {
    const int differ = a ^ b;
    return edge_at(differ == 1 ? 0 : differ == 2 ? 1 : 2, a & b);
  }

  void add_polygon(std::uint32_t edge) {
    const LatticeKey key = signs_.edges()[edge];
    const int axis = axis_of(key), next = (axis + 1) % 3, last = (axis + 2) % 3;
    const LatticePlace place = place_of(key);
    const std::array<LatticePlace, 4> around = cells_around(place, axis);
    // The edge's position in each of the cells, and the face between each cell and the next.
    const int positions[4] = {3, 2, 0, 1};
    const LatticeKey faces[4] = {key_of(place.moved(last, -1), next), key_of(place, last), key_of(place, next),
                                 key_of(place.moved(next, -1), last)};
    std::vector<std::uint32_t>& polygon = polygon_;
    polygon.clear();
    std::size_t split = 4;  // position of the first vertex on a face
    for (std::size_t i = 0; i < 4; ++i) {
      const std::uint32_t cell = signs_.cells().find(key_of(around[i]));
      polygon.push_back(cells_[cell].at(4 * axis + positions[i]));
      const auto arc = arcs_.empty() ? arcs_.end() : arcs_.find(faces[i]);
      if (arc == arcs_.end() || (arc->second.edges[0] != key && arc->second.edges[1] != key)) continue;
      if (polygon.size() == i + 1) split = polygon.size();
      polygon.push_back(arc->second.vertex);
    }
    if (!signs_.is_lower_inside(edge)) {
      std::reverse(polygon.begin(), polygon.end());
      split = polygon.size() - 1 - split;
    }
    triangulate(crossings_[edge], polygon.size() == 4 ? best_start(crossings_[edge]) : split);
  }

  // Returns the start of the diagonal of a quad whose triangles agree better with the normal at the crossing.
  std::size_t best_start(const Crossing& at) const {
    double best = -2;
    std::size_t start = 0;
    for (std::size_t i = 0; i < 2; ++i) {
      const double agreement = std::min(agreement_of(i, i + 1, i + 2, at), agreement_of(i, i + 2, (i + 3) % 4, at));
      constexpr double kTie = 1e-6;
      const bool shorter = i == 0 || diagonal(i) < diagonal(0);
      if (agreement > best + kTie || (agreement > best - kTie && shorter)) best = agreement, start = i;
    }
    return start;
  }
  double diagonal(std::size_t i) const {
    return glm::distance(result_.mesh.vertices[polygon_[i]], result_.mesh.vertices[polygon_[i + 2]]);
  }
  double agreement_of(std::size_t a, std::size_t b, std::size_t c, const Crossing& at) const {
    const auto& vertices = result_.mesh.vertices;
    const glm::dvec3 normal = area_normal({vertices[polygon_[a]], vertices[polygon_[b]], vertices[polygon_[c]]});
    const double length = glm::length(normal);
    return length > 0 ? glm::dot(normal, at.normal) / length : -1;
  }

  // Adds the polygon as a fan around its vertex number `start`.
  void triangulate(const Crossing& at, std::size_t start) {
    const std::size_t count = polygon_.size();
    for (std::size_t i = 1; i + 1 < count; ++i) {
      result_.mesh.triangles.push_back(
          {{polygon_[start], polygon_[(start + i) % count], polygon_[(start + i + 1) % count]}, at.surface});
    }
  }

  const CellLattice& lattice_;
  const SignedLattice& signs_;
  const std::vector<Crossing>& crossings_;
  Contour result_;
  std::vector<CellVertices> cells_;                 // [cell] of crossed cells
  std::unordered_map<LatticeKey, ArcVertex> arcs_;  // [face]
  std::vector<std::uint32_t> polygon_;
};

}  // namespace

compiler::Box inset_box(const CellLattice& lattice, LatticePlace cell) {
  const glm::dvec3 lo(lattice.corner(cell)), hi(lattice.corner(cell.corner(7)));
  return {lo + kCellInset * (hi - lo), hi - kCellInset * (hi - lo)};
}

Contour contour(const CellLattice& lattice, const SignedLattice& signs, const std::vector<Crossing>& crossings) {
  return DualContour(lattice, signs, crossings).run();
}

}  // namespace fathom::runtime
