#include "runtime/mesh/lost_parts.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace fathom::runtime {
namespace {

// Distances beyond the surface at which a search looks for the other side, in cells: a power of four each, then
// evenly to two cells, which measure the thickness.
constexpr double kFineDepths[] = {0x1p-12, 0x1p-10, 0x1p-8, 0x1p-6};
constexpr int kDepthsPerCell = 16, kEvenDepths = 32;
constexpr int kAllDepths = static_cast<int>(std::size(kFineDepths)) + kEvenDepths;
constexpr int kNewtonSteps = 4;
// Number of cells by which the mesh may fall short of a sharp edge or tip, which is thin at any resolution.
constexpr int kReachCells = 2;

double depth(int i) {
  constexpr int kFine = static_cast<int>(std::size(kFineDepths));
  return i < kFine ? kFineDepths[i] : static_cast<double>(i - kFine + 1) / kDepthsPerCell;
}

// True if a cell with signs of both kinds is within `reach` cells.
bool is_near_crossed(const SignedLattice& signs, std::uint32_t cell, int reach) {
  const LatticePlace place = place_of(signs.cells()[cell]);
  for (int z = -reach; z <= reach; ++z) {
    for (int y = -reach; y <= reach; ++y) {
      for (int x = -reach; x <= reach; ++x) {
        const LatticePlace near = place.moved(0, x).moved(1, y).moved(2, z);
        if (std::min({near.at[0], near.at[1], near.at[2]}) < 0) continue;
        const std::uint32_t other = signs.cells().find(key_of(near));
        if (other != KeyMap::kNone && signs.is_crossed(other)) return true;
      }
    }
  }
  return false;
}

// A search in one cell.
struct Search {
  std::uint32_t cell;
  bool inside;         // side of the cell's corners
  glm::dvec3 point;    // in the cell, nearer to the surface with every step
  glm::dvec3 towards;  // unit vector to the surface
};

class LostPartSearch {
 public:
  LostPartSearch(const MeshField& field, const CellLattice& lattice, const SignedLattice& signs, int threads)
      : field_(field), lattice_(lattice), signs_(signs), threads_(threads) {}

  std::vector<LostPart> run() {
    for (std::uint32_t cell = 0; cell < signs_.cells().size(); ++cell) {
      if (is_near_crossed(signs_, cell, 1)) continue;
      const LatticePlace place = place_of(signs_.cells()[cell]);
      const glm::dvec3 lo(lattice_.corner(place)), hi(lattice_.corner(place.corner(7)));
      searches_.push_back({cell, signs_.inside(cell) != 0, 0.5 * (lo + hi), glm::dvec3(0)});
    }
    for (int step = 0; step < kNewtonSteps; ++step) approach();
    look_beyond();
    std::vector<LostPart> parts;
    for (const auto& [name, part] : found_) parts.push_back(part);
    return parts;
  }

 private:
  // Moves every search along the gradient to where a field of constant slope would be zero, within its cell.
  void approach() {
    points_.clear();
    for (const Search& search : searches_) points_.push_back(search.point);
    field_.evaluate(points_, MeshField::Values::Distance, values_, threads_);
    field_.find_surfaces(points_, surfaces_, threads_);
    for (std::size_t i = 0; i < searches_.size(); ++i) {
      Search& search = searches_[i];
      search.towards = surfaces_[i].normal * (search.inside ? 1.0 : -1.0);
      const LatticePlace place = place_of(signs_.cells()[search.cell]);
      const glm::dvec3 lo(lattice_.corner(place)), hi(lattice_.corner(place.corner(7)));
      const double way = std::abs(static_cast<double>(values_[i])) / field_.field().step_lipschitz();
      if (std::isfinite(way)) search.point = glm::clamp(search.point + way * search.towards, lo, hi);
    }
  }

  void look_beyond() {
    points_.clear();
    for (const Search& search : searches_) {
      for (int i = 0; i < kAllDepths; ++i)
        points_.push_back(search.point + depth(i) * lattice_.cell * search.towards);
    }
    field_.evaluate(points_, MeshField::Values::Distance, values_, threads_);
    std::vector<std::size_t> lost;
    std::vector<double> thickness;
    PointArrays places;
    for (std::size_t s = 0; s < searches_.size(); ++s) {
      int first = -1, last = -1;
      for (int i = 0; i < kAllDepths; ++i) {
        const std::size_t at = s * kAllDepths + static_cast<std::size_t>(i);
        const bool beyond =
            field_.side(points_[at], values_[at]) == (searches_[s].inside ? Side::Outside : Side::Inside);
        if (beyond && first < 0) first = i;
        if (first >= 0 && !beyond) break;
        if (beyond) last = i;
      }
      // The other side further than a cell away is a part of another cell.
      if (first < 0 || depth(first) > 1 || is_near_crossed(signs_, searches_[s].cell, kReachCells)) continue;
      lost.push_back(s);
      thickness.push_back(depth(last) * lattice_.cell);
      places.push_back(searches_[s].point + depth(first) * lattice_.cell * searches_[s].towards);
    }
    field_.find_surfaces(places, surfaces_, threads_);
    for (std::size_t k = 0; k < lost.size(); ++k) {
      const bool gap = searches_[lost[k]].inside;
      const LostPart part{surfaces_[k].surface, gap, glm::dvec3(places[k]), thickness[k], 1};
      const auto [at, is_new] = found_.try_emplace({part.surface, gap}, part);
      if (is_new) continue;
      const std::size_t cells = at->second.cells + 1;
      if (part.thickness < at->second.thickness) at->second = part;
      at->second.cells = cells;
    }
  }

  const MeshField& field_;
  const CellLattice& lattice_;
  const SignedLattice& signs_;
  const int threads_;
  std::vector<Search> searches_;
  PointArrays points_;
  std::vector<float> values_;
  std::vector<MeshField::SurfacePoint> surfaces_;
  std::map<std::pair<std::uint32_t, bool>, LostPart> found_;  // by surface and kind
};

}  // namespace

std::vector<LostPart> find_lost_parts(const MeshField& field, const CellLattice& lattice, const SignedLattice& signs,
                                      int threads) {
  return LostPartSearch(field, lattice, signs, threads).run();
}

}  // namespace fathom::runtime
