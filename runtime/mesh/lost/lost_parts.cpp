#include "runtime/mesh/lost/lost_parts.h"

#include <algorithm>
#include <map>
#include <memory>
#include <tuple>

#include "runtime/mesh/lost/near_pieces.h"
#include "runtime/mesh/lost/thin_places.h"
#include "runtime/mesh/lost/thin_region.h"
#include "vm/program/parallel_for.h"

namespace fathom::runtime {
namespace {

// Number of cells by which the mesh may fall short of a sharp edge or tip, which is thin at any resolution.
constexpr int kReachCells = 2;

// Numbers of places that are examined, and of all balls of their walks, at least kLeastBalls each. A fractal has tens
// of thousands of places, which would take most of the time of a mesh.
constexpr std::size_t kMostPlaces = 8192, kAllBalls = 1024 * ThinRegionSearch::kMostBalls, kLeastBalls = 60;

using Fate = ThinRegion::Fate;

// The numbers of places of one side in one block of two cells along each axis, ascending.
using Group = std::vector<std::size_t>;

std::vector<Group> group(const SignedLattice& signs, const std::vector<ThinPlace>& places) {
  std::map<std::pair<LatticeKey, Side>, std::size_t> numbers;
  std::vector<Group> groups;
  for (std::size_t i = 0; i < places.size(); ++i) {
    LatticePlace block = place_of(signs.cells()[places[i].cell]);
    for (auto& at : block.at) at /= 2;
    const auto [at, is_new] = numbers.try_emplace({key_of(block), places[i].side}, groups.size());
    if (is_new) groups.emplace_back();
    groups[at->second].push_back(i);
  }
  return groups;
}

// Leaves at most kMostPlaces, evenly by number: first those on edges and between pieces, where the mesh is most
// likely wrong.
std::vector<ThinPlace> limited(const std::vector<ThinPlace>& all) {
  if (all.size() <= kMostPlaces) return all;
  std::vector<ThinPlace> places;
  for (const bool is_first : {true, false}) {
    std::vector<const ThinPlace*> some;
    for (const ThinPlace& place : all) {
      if ((place.on_edge || place.is_between_pieces) == is_first) some.push_back(&place);
    }
    const std::size_t count = std::min(some.size(), kMostPlaces - places.size());
    for (std::size_t i = 0; i < count; ++i) places.push_back(*some[i * some.size() / count]);
  }
  return places;
}

// Examines the places. In a group, all after one in a sheet are taken for places of that sheet.
std::vector<ThinRegion> examine_all(const MeshField& field, const CellLattice& lattice, const SignedLattice& signs,
                                    const LatticeLabels& labels, const std::vector<ThinPlace>& places, int threads) {
  std::vector<ThinRegion> regions(places.size());
  if (places.empty()) return regions;
  const std::vector<Group> groups = group(signs, places);
  const auto balls =
      static_cast<int>(std::clamp<std::size_t>(kAllBalls / places.size(), kLeastBalls, ThinRegionSearch::kMostBalls));
  parallel_for(
      threads, groups.size(),
      [&] { return std::make_unique<ThinRegionSearch>(field, lattice, signs, labels, balls); },
      [&](std::unique_ptr<ThinRegionSearch>& search, std::size_t number) {
        const ThinRegion* lost = nullptr;
        for (const std::size_t i : groups[number]) {
          const bool is_apart = !is_near_crossed(signs, places[i].cell, kReachCells);
          regions[i] = lost ? *lost : search->examine(places[i], is_apart);
          if (regions[i].is_sheet && !regions[i].tapers) lost = &regions[i];
        }
      });
  return regions;
}

// Returns the place that a warning names of two: one that finer cells keep, and of those the thinnest.
bool is_better(const LostPart& a, const LostPart& b) {
  if (a.tapers != b.tapers) return b.tapers;
  return a.tapers ? a.thickness > b.thickness : a.thickness < b.thickness;
}

// Returns the number of pieces of the solid that torn parts connect, less one for each whole.
std::size_t count_islands(const std::vector<ThinPlace>& places, const std::vector<ThinRegion>& regions) {
  std::map<std::uint32_t, std::uint32_t> numbers;  // [label]
  DisjointSets sets(0);
  std::size_t islands = 0;
  for (std::size_t i = 0; i < regions.size(); ++i) {
    if (regions[i].fate != Fate::Torn || places[i].side != Side::Inside) continue;
    std::vector<std::uint32_t> pieces;
    for (const std::uint32_t label : regions[i].labels) {
      const auto [at, is_new] = numbers.try_emplace(label, static_cast<std::uint32_t>(numbers.size()));
      if (is_new) sets.add();
      pieces.push_back(at->second);
    }
    for (const std::uint32_t piece : pieces) islands += sets.join(pieces.front(), piece);
  }
  return islands;
}

}  // namespace

LostParts find_lost_parts(const MeshField& field, const CellLattice& lattice, const SignedLattice& signs,
                          int threads) {
  const LatticeLabels labels(signs, lattice);
  std::vector<ThinPlace> places = find_narrow_places(field, lattice, signs, labels, threads);
  const std::vector<ThinPlace> thin = find_thin_places(field, lattice, signs, threads);
  places.insert(places.end(), thin.begin(), thin.end());
  places = limited(places);
  const std::vector<ThinRegion> regions = examine_all(field, lattice, signs, labels, places, threads);
  std::map<std::tuple<std::uint32_t, std::uint32_t, bool, bool>, LostPart> found;  // by surfaces and kind
  for (std::size_t i = 0; i < regions.size(); ++i) {
    const ThinRegion& region = regions[i];
    if (region.fate == Fate::Kept) continue;
    const bool is_gap = places[i].side == Side::Outside, is_torn = region.fate == Fate::Torn;
    const std::uint32_t surface = region.surfaces[0], other = is_gap ? region.surfaces[1] : surface;
    const LostPart part{surface, other, is_gap, is_torn, region.tapers, region.place, region.thickness, 1};
    const auto [at, is_new] = found.try_emplace({surface, other, is_gap, is_torn}, part);
    if (is_new) continue;
    LostPart& known = at->second;
    const std::size_t count = known.places + 1;
    if (is_better(part, known)) known = part;
    known.places = count;
  }
  LostParts lost;
  for (const auto& [name, part] : found) lost.parts.push_back(part);
  lost.islands = count_islands(places, regions);
  return lost;
}

}  // namespace fathom::runtime
