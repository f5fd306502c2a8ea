#include "runtime/mesh/lattice/signed_lattice.h"

#include <memory>

namespace fathom::runtime {
namespace {

glm::vec3 face_centre(const CellLattice& lattice, LatticeKey face) {
  const LatticePlace place = place_of(face);
  const int axis = axis_of(face);
  const unsigned opposite = 7u & ~(1u << axis);
  const glm::dvec3 lo(lattice.corner(place)), hi(lattice.corner(place.corner(opposite)));
  return 0.5 * (lo + hi);
}

// Evaluates the sides of points. Double decides the points that float leaves open.
void find_sides(const MeshField& field, const PointArrays& points, int threads, std::vector<std::uint8_t>& inside) {
  std::vector<float> values;
  field.evaluate(points, MeshField::Values::Distance, values, threads);
  const auto scratch = std::make_unique<RealScratch>();
  inside.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Side side = field.side(points[i], values[i]);
    inside[i] = side == Side::Unknown ? field.is_inside(points[i], *scratch) : side == Side::Inside;
  }
}

}  // namespace

SignSource signs_of(const MeshField& field, const CellLattice& lattice, int threads) {
  return {[&field, &lattice, threads](std::span<const LatticeKey> corners, std::vector<std::uint8_t>& inside) {
            PointArrays points;
            for (const LatticeKey key : corners) points.push_back(glm::dvec3(lattice.corner(place_of(key))));
            find_sides(field, points, threads, inside);
            for (std::size_t i = 0; i < corners.size(); ++i) {
              if (lattice.is_border(place_of(corners[i]))) inside[i] = 0;
            }
          },
          [&field, &lattice, threads](std::span<const LatticeKey> faces, std::vector<std::uint8_t>& inside) {
            PointArrays points;
            for (const LatticeKey key : faces) points.push_back(glm::dvec3(face_centre(lattice, key)));
            find_sides(field, points, threads, inside);
          }};
}

std::array<LatticePlace, 4> cells_around(LatticePlace edge, int axis) {
  const int next = (axis + 1) % 3, last = (axis + 2) % 3;
  return {edge.moved(next, -1).moved(last, -1), edge.moved(last, -1), edge, edge.moved(next, -1)};
}

SignedLattice::SignedLattice(const std::vector<LatticeKey>& cells, const SignSource& source) {
  std::vector<LatticeKey> added = cells;
  while (!added.empty()) {
    const auto first = static_cast<std::uint32_t>(cells_.size());
    for (const LatticeKey cell : added) cells_.insert(cell);
    read_corners(first, source);
    added.clear();
    find_edges(first, added);
  }
  find_faces(source);
}

void SignedLattice::read_corners(std::uint32_t first_cell, const SignSource& source) {
  const std::size_t known = corners_.size();
  std::vector<std::array<std::uint32_t, 8>> corners_of(cells_.size() - first_cell);
  for (std::size_t i = 0; i < corners_of.size(); ++i) {
    const LatticePlace cell = place_of(cells_[first_cell + i]);
    for (unsigned corner = 0; corner < 8; ++corner)
      corners_of[i][corner] = corners_.insert(key_of(cell.corner(corner)));
  }
  std::vector<std::uint8_t> inside;
  source.corners(std::span(corners_.keys()).subspan(known), inside);
  corner_inside_.insert(corner_inside_.end(), inside.begin(), inside.end());
  for (const auto& corners : corners_of) {
    unsigned signs = 0;
    for (unsigned corner = 0; corner < 8; ++corner) signs |= unsigned{corner_inside_[corners[corner]]} << corner;
    inside_.push_back(static_cast<std::uint8_t>(signs));
  }
}

// Finds the edges of new cells, and the cells that are missing around them.
void SignedLattice::find_edges(std::uint32_t first_cell, std::vector<LatticeKey>& missing) {
  for (std::uint32_t cell = first_cell; cell < inside_.size(); ++cell) {
    if (!is_crossed(cell)) continue;
    for (int edge = 0; edge < kCubeEdges; ++edge) {
      const CubeEdge ends = cube_edge(edge);
      const bool lower = inside_[cell] >> ends.lower & 1, upper = inside_[cell] >> ends.upper() & 1;
      if (lower == upper) continue;
      const LatticePlace place = place_of(cells_[cell]).corner(ends.lower);
      if (edges_.insert(key_of(place, ends.axis)) < lower_inside_.size()) continue;
      lower_inside_.push_back(lower);
      for (const LatticePlace around : cells_around(place, ends.axis)) {
        if (cells_.find(key_of(around)) == KeyMap::kNone) missing.push_back(key_of(around));
      }
    }
  }
}

void SignedLattice::find_faces(const SignSource& source) {
  for (std::uint32_t cell = 0; cell < inside_.size(); ++cell) {
    if (!is_crossed(cell)) continue;
    for (int face = 0; face < kCubeFaces; ++face) {
      if (is_ambiguous(inside_[cell], face)) faces_.insert(face_key(place_of(cells_[cell]), face));
    }
  }
  source.face_centres(faces_.keys(), open_);
}

std::optional<std::array<unsigned, 2>> SignedLattice::joined_corners(std::uint32_t cell, int face) const {
  if (!is_ambiguous(inside_[cell], face)) return std::nullopt;
  const std::array<int, 4> corners = face_corners(face);
  const bool first_inside = inside_[cell] >> corners[0] & 1;
  const std::size_t start = first_inside == is_open(face_key(place_of(cells_[cell]), face)) ? 0 : 1;
  return std::array{static_cast<unsigned>(corners[start]), static_cast<unsigned>(corners[start + 2])};
}

CubeCycles SignedLattice::cycles(std::uint32_t cell) const {
  unsigned open = 0;
  for (int face = 0; face < kCubeFaces; ++face) {
    if (!is_ambiguous(inside_[cell], face)) continue;
    open |= unsigned{open_[faces_.find(face_key(place_of(cells_[cell]), face))]} << face;
  }
  return trace_cycles(inside_[cell], open);
}

}  // namespace fathom::runtime
