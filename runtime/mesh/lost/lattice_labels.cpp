#include "runtime/mesh/lost/lattice_labels.h"

#include <map>

namespace fathom::runtime {
namespace {

// Numbers of the sets' elements: the corners, and for each edge that crosses the surface its two sides.
struct Elements {
  const SignedLattice& signs;

  std::size_t count() const { return signs.corners().size() + 2 * signs.edges().size(); }
  std::uint32_t side(std::uint32_t edge, bool inside) const {
    return static_cast<std::uint32_t>(signs.corners().size() + 2 * edge + (inside ? 1 : 0));
  }
  std::uint32_t corner(LatticePlace cell, unsigned number) const {
    return signs.corners().find(key_of(cell.corner(number)));
  }
  std::uint32_t edge(LatticePlace cell, int number) const {
    const CubeEdge ends = cube_edge(number);
    return signs.edges().find(key_of(cell.corner(ends.lower), ends.axis));
  }
};

void join_edges(const Elements& elements, std::uint32_t cell, DisjointSets& sets) {
  const unsigned inside = elements.signs.inside(cell);
  const LatticePlace place = place_of(elements.signs.cells()[cell]);
  for (int number = 0; number < kCubeEdges; ++number) {
    const CubeEdge ends = cube_edge(number);
    const std::uint32_t lower = elements.corner(place, ends.lower), upper = elements.corner(place, ends.upper());
    const bool lower_inside = inside >> ends.lower & 1, upper_inside = inside >> ends.upper() & 1;
    if (lower_inside == upper_inside) {
      sets.join(lower, upper);
      continue;
    }
    const std::uint32_t edge = elements.edge(place, number);
    sets.join(lower, elements.side(edge, lower_inside));
    sets.join(upper, elements.side(edge, upper_inside));
  }
}

// Joins both sides of the edges of a piece of the surface, and corners across faces with diagonal signs.
void join_pieces(const Elements& elements, std::uint32_t cell, DisjointSets& sets) {
  const LatticePlace place = place_of(elements.signs.cells()[cell]);
  const CubeCycles cycles = elements.signs.cycles(cell);
  std::array<std::uint32_t, 4> firsts;
  firsts.fill(KeyMap::kNone);
  for (int number = 0; number < kCubeEdges; ++number) {
    const std::uint8_t cycle = cycles.cycle_of[static_cast<std::size_t>(number)];
    if (cycle == CubeCycles::kNone) continue;
    const std::uint32_t edge = elements.edge(place, number);
    std::uint32_t& first = firsts[cycle];
    if (first == KeyMap::kNone) first = edge;
    for (const bool side : {false, true}) sets.join(elements.side(first, side), elements.side(edge, side));
  }
  for (int face = 0; face < kCubeFaces; ++face) {
    const auto joined = elements.signs.joined_corners(cell, face);
    if (joined) sets.join(elements.corner(place, (*joined)[0]), elements.corner(place, (*joined)[1]));
  }
}

// The utmost corners of a set, in both directions along each axis.
struct UtmostCorners {
  std::array<std::uint32_t, 6> corners;  // [2 axis + (1: up)]
};

std::map<std::uint32_t, UtmostCorners> find_utmost(const SignedLattice& signs, DisjointSets& sets) {
  std::map<std::uint32_t, UtmostCorners> utmost;  // [root]
  for (std::uint32_t corner = 0; corner < signs.corners().size(); ++corner) {
    const auto [at, is_new] = utmost.try_emplace(sets.root(corner));
    const LatticePlace place = place_of(signs.corners()[corner]);
    for (std::size_t i = 0; i < 6; ++i) {
      std::uint32_t& known = at->second.corners[i];
      if (is_new) known = corner;
      const std::int32_t here = place.at[i / 2], there = place_of(signs.corners()[known]).at[i / 2];
      if (i % 2 == 0 ? here < there : here > there) known = corner;
    }
  }
  return utmost;
}

// Joins sets that cells without a zero connect. Element `beyond` is what is outside of the lattice.
void join_across(const SignedLattice& signs, const CellLattice& lattice, std::uint32_t beyond, DisjointSets& sets) {
  for (const auto& [root, utmost] : find_utmost(signs, sets)) {
    for (std::size_t i = 0; i < 6; ++i) {
      const std::uint32_t corner = utmost.corners[i];
      const int axis = static_cast<int>(i / 2), step = i % 2 == 0 ? -1 : 1;
      LatticePlace place = place_of(signs.corners()[corner]);
      std::uint32_t met = KeyMap::kNone;
      bool within = true;
      while (within && met == KeyMap::kNone) {
        place = place.moved(axis, step);
        within = place.at[i / 2] >= 0 && place.at[i / 2] <= lattice.cells(axis);
        if (within) met = signs.corners().find(key_of(place));
      }
      if (!within) {
        sets.join(corner, beyond);
      } else if (signs.is_corner_inside(met) == signs.is_corner_inside(corner)) {
        sets.join(corner, met);
      }
    }
  }
}

}  // namespace

LatticeLabels::LatticeLabels(const SignedLattice& signs, const CellLattice& lattice) {
  const Elements elements{signs};
  DisjointSets sets(elements.count() + 1);
  for (std::uint32_t cell = 0; cell < signs.cells().size(); ++cell) {
    join_edges(elements, cell, sets);
    if (signs.is_crossed(cell)) join_pieces(elements, cell, sets);
  }
  join_across(signs, lattice, static_cast<std::uint32_t>(elements.count()), sets);
  for (std::uint32_t corner = 0; corner < signs.corners().size(); ++corner) labels_.push_back(sets.root(corner));
}

}  // namespace fathom::runtime
