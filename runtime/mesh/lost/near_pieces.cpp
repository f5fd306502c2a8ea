#include "runtime/mesh/lost/near_pieces.h"

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <tuple>

#include "vm/program/parallel_for.h"

namespace fathom::runtime {
namespace {

// Distance of corners that count as near, in cells along each axis: blunt tips of the mesh end that far from what they
// touch. A gap is followed once per pair of pieces and block of kGapCells cells along each axis.
constexpr int kNearCells = 4, kGapCells = 2;
constexpr std::size_t kMostGaps = 1024;  // that are followed

LatticeKey block_of(LatticePlace corner, int cells) {
  for (auto& at : corner.at) at /= cells;
  return key_of(corner);
}

// Two corners on one side of the surface and of different pieces.
struct NearPair {
  LatticePlace from, to;
  std::uint32_t cell;  // beside `from`
  Side side;
};

class NearPairSearch {
 public:
  NearPairSearch(const SignedLattice& signs, const LatticeLabels& labels) : signs_(signs), labels_(labels) {}

  std::vector<NearPair> run() {
    find_blocks();
    std::set<std::uint32_t> known;
    for (const LatticeKey edge : signs_.edges().keys()) {
      const std::uint32_t cell = signs_.cells().find(key_of(cells_around(place_of(edge), axis_of(edge)).front()));
      for (const int end : {0, 1}) {
        const LatticePlace corner = place_of(edge).moved(axis_of(edge), end);
        const std::uint32_t number = signs_.corners().find(key_of(corner));
        if (known.insert(number).second && may_have_another(corner, number)) add_nearest(corner, number, cell);
      }
    }
    std::vector<NearPair> all;
    for (const auto& [name, near] : found_) all.push_back(near);
    return all;
  }

 private:
  static constexpr std::uint32_t kSeveral = KeyMap::kNone - 1;

  // The label of a block's corners of each side, kNone or kSeveral.
  void find_blocks() {
    for (std::uint32_t corner = 0; corner < signs_.corners().size(); ++corner) {
      const std::uint32_t block = blocks_.insert(block_of(place_of(signs_.corners()[corner]), kNearCells));
      if (block == labels_of_.size()) labels_of_.push_back({KeyMap::kNone, KeyMap::kNone});
      std::uint32_t& known = labels_of_[block][signs_.is_corner_inside(corner) ? 1 : 0];
      known = known == KeyMap::kNone || known == labels_.of(corner) ? labels_.of(corner) : kSeveral;
    }
  }

  // True if a block at the corner's has another piece of its side.
  bool may_have_another(LatticePlace corner, std::uint32_t number) const {
    for (int i = 0; i < 27; ++i) {
      LatticePlace near = corner;
      for (int axis = 0, rest = i; axis < 3; ++axis, rest /= 3) near = near.moved(axis, (rest % 3 - 1) * kNearCells);
      if (std::min({near.at[0], near.at[1], near.at[2]}) < 0) continue;
      const std::uint32_t block = blocks_.find(block_of(near, kNearCells));
      if (block == KeyMap::kNone) continue;
      const std::uint32_t label = labels_of_[block][signs_.is_corner_inside(number) ? 1 : 0];
      if (label != KeyMap::kNone && label != labels_.of(number)) return true;
    }
    return false;
  }

  void add_nearest(LatticePlace corner, std::uint32_t number, std::uint32_t cell) {
    const bool inside = signs_.is_corner_inside(number);
    const std::uint32_t own = labels_.of(number);
    int least = 3 * kNearCells * kNearCells + 1;
    LatticePlace nearest{};
    std::uint32_t label = 0;
    for (int z = -kNearCells; z <= kNearCells; ++z) {
      for (int y = -kNearCells; y <= kNearCells; ++y) {
        for (int x = -kNearCells; x <= kNearCells; ++x) {
          const int distance = x * x + y * y + z * z;
          if (distance >= least) continue;
          const LatticePlace near = corner.moved(0, x).moved(1, y).moved(2, z);
          if (std::min({near.at[0], near.at[1], near.at[2]}) < 0) continue;
          const std::uint32_t other = signs_.corners().find(key_of(near));
          if (other == KeyMap::kNone || signs_.is_corner_inside(other) != inside) continue;
          if (labels_.of(other) == own) continue;
          least = distance, nearest = near, label = labels_.of(other);
        }
      }
    }
    if (least > 3 * kNearCells * kNearCells) return;
    const auto [at, is_new] =
        found_.try_emplace({block_of(corner, kGapCells), std::min(label, own), std::max(label, own)});
    if (is_new) at->second = {corner, nearest, cell, inside ? Side::Inside : Side::Outside};
  }

  const SignedLattice& signs_;
  const LatticeLabels& labels_;
  KeyMap blocks_;                                        // of kNearCells cells along each axis
  std::vector<std::array<std::uint32_t, 2>> labels_of_;  // [block][1: inside]
  std::map<std::tuple<LatticeKey, std::uint32_t, std::uint32_t>, NearPair> found_;  // by block and pieces
};

}  // namespace

std::vector<ThinPlace> find_narrow_places(const MeshField& field, const CellLattice& lattice,
                                          const SignedLattice& signs, const LatticeLabels& labels, int threads) {
  const std::vector<NearPair> near = NearPairSearch(signs, labels).run();
  const std::size_t count = std::min(near.size(), kMostGaps);
  const auto pair = [&](std::size_t i) -> const NearPair& { return near[i * near.size() / count]; };
  std::vector<std::optional<glm::dvec3>> met(count);
  parallel_for(
      threads, count, [&] { return std::make_unique<ThinRegionSearch>(field, lattice, signs, labels); },
      [&](std::unique_ptr<ThinRegionSearch>& search, std::size_t i) {
        met[i] = search->follow_gap(lattice.corner(pair(i).from), lattice.corner(pair(i).to));
      });
  std::vector<ThinPlace> places;
  for (std::size_t i = 0; i < count; ++i) {
    if (met[i]) places.push_back({pair(i).cell, *met[i], pair(i).side, false, true});
  }
  return places;
}

}  // namespace fathom::runtime
