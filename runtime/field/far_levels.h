// The values that distances far from every surface take in a scene of many objects.
//
// Regions (regions.h) evaluate such a scene fast because they know what matters near a point only. Rays have to take
// the same steps with them as without them, to the bit. So every evaluation of such a scene, of the whole program
// too, rounds alike: a distance above `first` goes down to the next first * 4^k. A cell in which all distances round
// to one value needs no program, and elsewhere what lies further than the cell's highest level does not matter.
// Tested by: tests/runtime/field/regions_test.cpp
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "vm/interpret/evaluate.h"

namespace fathom::runtime {

struct FarLevels {
  static constexpr float kNone = std::numeric_limits<float>::infinity();

  float first = kNone;  // scene units; distances up to here are exact
  // Outside the box of the bounded parts no distance is above half of the way there, along the axis on which that is
  // longest, but at least `first` and at most `most`: so these parts do not matter where they are far.
  float most = kNone;
  std::array<float, 3> lo{}, hi{};

  bool used() const { return first < kNone; }

  // The largest level that is not above a distance; a distance up to `first` is its own. Of NaN NaN.
  template <class S>
  S level(S distance) const {
    using Bits = std::conditional_t<sizeof(S) == sizeof(float), std::uint32_t, std::uint64_t>;
    constexpr int kDigits = std::numeric_limits<S>::digits;  // the exponent's second bit is worth a factor of 4
    constexpr Bits kWithin = (Bits{1} << kDigits) - 1;
    const S least = static_cast<S>(first);
    const Bits begin = std::bit_cast<Bits>(least);
    const S rounded = std::bit_cast<S>(begin + ((std::bit_cast<Bits>(distance) - begin) & ~kWithin));
    return distance > least && distance < std::numeric_limits<S>::infinity() ? rounded : distance;
  }

  float cap(float x, float y, float z) const {
    return cap_at(std::max({lo[0] - x, x - hi[0], lo[1] - y, y - hi[1], lo[2] - z, z - hi[2]}));
  }
  // The largest one in a box.
  float cap(const std::array<float, 3>& from, const std::array<float, 3>& to) const {
    float away = -kNone, nearest = -kNone;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      away = std::max({away, lo[axis] - from[axis], to[axis] - hi[axis]});
      nearest = std::max({nearest, lo[axis] - to[axis], from[axis] - hi[axis]});
    }
    return nearest > 0 ? cap_at(away) : kNone;
  }

  // What a distance at a place counts as.
  template <class S>
  S operator()(S distance, float x, float y, float z) const {
    const S highest = static_cast<S>(cap(x, y, z));
    return level(highest < distance ? highest : distance);
  }

  void apply(vm::Points points, std::size_t count, float* distance) const {
    if (!used()) return;
    for (std::size_t i = 0; i < count; ++i) distance[i] = (*this)(distance[i], points.x[i], points.y[i], points.z[i]);
  }

 private:
  float cap_at(float away) const { return away > 0 ? std::min(std::max(0.5f * away, first), most) : kNone; }
};

}  // namespace fathom::runtime
