#include "runtime/mesh/lattice/find_cells.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace fathom::runtime {
namespace {

// Nodes of one level of the octree. A node of level k has 2^k cells along each axis, except at the lattice's end.
class CellOctree {
 public:
  CellOctree(const MeshField& field, const CellLattice& lattice, int threads)
      : field_(field), lattice_(lattice), threads_(threads) {}

  // Replaces the nodes by those that may contain a zero.
  void prune(std::vector<LatticeKey>& nodes, int level) {
    centres_.clear();
    halves_.clear();
    for (const LatticeKey node : nodes) add_centre(place_of(node), level);
    field_.evaluate(centres_, MeshField::Values::Radius, radii_, threads_);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const float error = field_.error(centres_[i], radii_[i]) * std::max(1.0f, field_.field().inv_lipschitz);
      // NaN proves nothing.
      if (!(std::abs(radii_[i]) > halves_[i] + error)) nodes[kept++] = nodes[i];
    }
    nodes.resize(kept);
  }

  // Returns the children of the nodes within the lattice.
  std::vector<LatticeKey> split(const std::vector<LatticeKey>& nodes, int level) const {
    std::vector<LatticeKey> children;
    children.reserve(8 * nodes.size());
    for (const LatticeKey node : nodes) {
      for (unsigned child = 0; child < 8; ++child) {
        LatticePlace place = place_of(node);
        for (auto& at : place.at) at *= 2;
        place = place.corner(child);
        bool within = true;
        for (int axis = 0; axis < 3; ++axis) within = within && start(place, axis, level - 1) < lattice_.cells(axis);
        if (within) children.push_back(key_of(place));
      }
    }
    return children;
  }

 private:
  static int start(LatticePlace place, int axis, int level) {
    return place.at[static_cast<std::size_t>(axis)] << level;
  }

  void add_centre(LatticePlace node, int level) {
    glm::dvec3 lo, hi;
    for (int axis = 0; axis < 3; ++axis) {
      const int first = start(node, axis, level), last = std::min(first + (1 << level), lattice_.cells(axis));
      lo[axis] = static_cast<double>(lattice_.coordinate(axis, first));
      hi[axis] = static_cast<double>(lattice_.coordinate(axis, last));
    }
    centres_.push_back(0.5 * (lo + hi));
    const glm::dvec3 centre(centres_[centres_.size() - 1]);  // as rounded
    halves_.push_back(static_cast<float>(glm::length(glm::max(centre - lo, hi - centre)) * (1 + 0x1p-20)));
  }

  const MeshField& field_;
  const CellLattice& lattice_;
  const int threads_;
  PointArrays centres_;
  std::vector<float> halves_, radii_;  // [node] half of the diagonal, and the field's radius, scene units
};

}  // namespace

FoundCells find_cells(const MeshField& field, const CellLattice& lattice, std::size_t most, int threads) {
  int level = 0;
  while (1 << level < lattice.most_cells()) ++level;
  CellOctree octree(field, lattice, threads);
  FoundCells found;
  found.cells = {key_of({{0, 0, 0}})};
  for (;; --level) {
    octree.prune(found.cells, level);
    // A surface passes through about four of the eight children of a node.
    found.expected = found.cells.size() << 2 * level;
    if (found.cells.size() > most || (level <= 2 && found.expected > 2 * most)) {
      return {{}, true, found.expected};
    }
    if (level == 0) return found;
    found.cells = octree.split(found.cells, level);
  }
}

}  // namespace fathom::runtime
