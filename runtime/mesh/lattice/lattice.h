// The lattice of a mesh: cubes of one size, whose corners lie at floats. Corners, edges, faces and cells are named by
// keys of 64 bits, and a KeyMap numbers the keys that occur.
// Tested by: tests/runtime/mesh/contour_test.cpp
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "compiler/geometry/box.h"

namespace fathom::runtime {

using LatticeKey = std::uint64_t;

// A place of the lattice: a corner, or the cell, edge or face that starts at the corner.
struct LatticePlace {
  std::array<std::int32_t, 3> at;

  LatticePlace moved(int axis, int by) const {
    LatticePlace place = *this;
    place.at[static_cast<std::size_t>(axis)] += by;
    return place;
  }
  LatticePlace corner(unsigned number) const {  // bit i of `number`: the upper corner along axis i
    return {{at[0] + static_cast<int>(number & 1), at[1] + static_cast<int>(number >> 1 & 1),
             at[2] + static_cast<int>(number >> 2)}};
  }
};

inline constexpr int kPlaceBits = 20;  // bits of a key per coordinate
inline LatticeKey key_of(LatticePlace place, int axis = 0) {
  return static_cast<LatticeKey>(place.at[0]) | static_cast<LatticeKey>(place.at[1]) << kPlaceBits |
         static_cast<LatticeKey>(place.at[2]) << 2 * kPlaceBits | static_cast<LatticeKey>(axis) << 3 * kPlaceBits;
}
inline LatticePlace place_of(LatticeKey key) {
  constexpr LatticeKey kMask = (LatticeKey{1} << kPlaceBits) - 1;
  return {{static_cast<std::int32_t>(key & kMask), static_cast<std::int32_t>(key >> kPlaceBits & kMask),
           static_cast<std::int32_t>(key >> 2 * kPlaceBits & kMask)}};
}
inline int axis_of(LatticeKey key) { return static_cast<int>(key >> 3 * kPlaceBits); }

struct CellLattice {
  std::array<std::vector<float>, 3> coordinates;  // [axis][corner] ascending, scene units
  double cell = 0;                                // edge of a cell, scene units; rounding makes cells unequal
  double diagonal = 0;                            // longest diagonal of a cell, scene units

  int cells(int axis) const { return static_cast<int>(coordinates[static_cast<std::size_t>(axis)].size()) - 1; }
  int most_cells() const { return std::max({cells(0), cells(1), cells(2)}); }
  float coordinate(int axis, int index) const {
    return coordinates[static_cast<std::size_t>(axis)][static_cast<std::size_t>(index)];
  }
  glm::vec3 corner(LatticePlace place) const {
    return {coordinate(0, place.at[0]), coordinate(1, place.at[1]), coordinate(2, place.at[2])};
  }
  bool is_border(LatticePlace corner) const {
    for (int axis = 0; axis < 3; ++axis) {
      const std::int32_t index = corner.at[static_cast<std::size_t>(axis)];
      if (index == 0 || index == cells(axis)) return true;
    }
    return false;
  }
};

// Makes a lattice of cells of edge `cell` around `box`, with more than one cell of margin. Its corners are off round
// coordinates, because faces of scenes often lie there and a corner on a face is on neither side. Returns an empty
// lattice if float does not tell the corners apart, or if keys are too short for their number.
CellLattice make_lattice(const compiler::Box& box, double cell);

// Numbers keys in the order of their insertion. Open addressing with linear probing (Knuth, TAOCP 3, 1973, 6.4).
class KeyMap {
 public:
  static constexpr std::uint32_t kNone = 0xffffffff;

  // Returns the number of the key, which is size() - 1 if the key is new.
  std::uint32_t insert(LatticeKey key);
  // Returns the number of the key, or kNone.
  std::uint32_t find(LatticeKey key) const;
  std::size_t size() const { return keys_.size(); }
  LatticeKey operator[](std::size_t number) const { return keys_[number]; }
  const std::vector<LatticeKey>& keys() const { return keys_; }

 private:
  std::size_t slot_of(LatticeKey key) const;
  void grow();

  std::vector<LatticeKey> keys_;      // [number]
  std::vector<std::uint32_t> slots_;  // number or kNone
  int shift_ = 64;                    // of the hash, to an index of slots_
};

}  // namespace fathom::runtime
