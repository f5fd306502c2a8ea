#include "runtime/mesh/lattice/lattice.h"

#include <cmath>

namespace fathom::runtime {
namespace {

// Margin below the box, in cells per axis: odd numbers, so that no plane of a scene lies on the lattice by intention.
constexpr std::array<double, 3> kLatticeMargins = {1.3717, 1.4391, 1.3049};

}  // namespace

CellLattice make_lattice(const compiler::Box& box, double cell) {
  constexpr double kMostCells = (1 << kPlaceBits) - 2;
  CellLattice lattice;
  lattice.cell = cell;
  glm::dvec3 longest(0);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int i = static_cast<int>(axis);
    const double lo = box.lo[i] - kLatticeMargins[axis] * cell;
    const double count = std::ceil((box.hi[i] - lo) / cell + 1.25);
    if (!(count < kMostCells)) return {};
    std::vector<float>& coordinates = lattice.coordinates[axis];
    for (int k = 0; k <= static_cast<int>(count); ++k) coordinates.push_back(static_cast<float>(lo + k * cell));
    for (std::size_t k = 1; k < coordinates.size(); ++k) {
      const double edge = static_cast<double>(coordinates[k]) - static_cast<double>(coordinates[k - 1]);
      longest[i] = std::max(longest[i], edge);
      // A vertex keeps a distance from its cell's sides (kCellInset in contour.cpp), which float has to resolve.
      const double resolution = 0x1p-22 * std::max(1e-30, std::abs(static_cast<double>(coordinates[k])));
      if (edge < 64 * resolution) return {};
    }
  }
  lattice.diagonal = std::sqrt(longest.x * longest.x + longest.y * longest.y + longest.z * longest.z);
  return lattice;
}

std::size_t KeyMap::slot_of(LatticeKey key) const {
  constexpr std::uint64_t kGolden = 0x9e3779b97f4a7c15;
  const std::uint64_t mixed = (key ^ key >> 29) * kGolden;
  return static_cast<std::size_t>((mixed ^ mixed >> 32) * kGolden >> shift_);
}

void KeyMap::grow() {
  shift_ = slots_.empty() ? 54 : shift_ - 1;
  slots_.assign(std::size_t{1} << (64 - shift_), kNone);
  const std::size_t mask = slots_.size() - 1;
  for (std::size_t number = 0; number < keys_.size(); ++number) {
    std::size_t slot = slot_of(keys_[number]);
    while (slots_[slot] != kNone) slot = (slot + 1) & mask;
    slots_[slot] = static_cast<std::uint32_t>(number);
  }
}

std::uint32_t KeyMap::insert(LatticeKey key) {
  if (5 * keys_.size() >= 3 * slots_.size()) grow();
  const std::size_t mask = slots_.size() - 1;
  std::size_t slot = slot_of(key);
  for (; slots_[slot] != kNone; slot = (slot + 1) & mask) {
    if (keys_[slots_[slot]] == key) return slots_[slot];
  }
  slots_[slot] = static_cast<std::uint32_t>(keys_.size());
  keys_.push_back(key);
  return slots_[slot];
}

std::uint32_t KeyMap::find(LatticeKey key) const {
  if (slots_.empty()) return kNone;
  const std::size_t mask = slots_.size() - 1;
  for (std::size_t slot = slot_of(key); slots_[slot] != kNone; slot = (slot + 1) & mask) {
    if (keys_[slots_[slot]] == key) return slots_[slot];
  }
  return kNone;
}

}  // namespace fathom::runtime
