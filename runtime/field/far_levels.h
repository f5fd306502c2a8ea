// Rounding of the distances far from every surface, in scenes of many objects.
//
// Regions (regions.h) evaluate these scenes fast because a region knows only what matters near a point. Rays must
// take the same steps with regions as without them, bit for bit. So all evaluations round alike, also those of the
// whole program: a distance above `first` is rounded down to the next level, first * 4^k. A cell in which all
// distances round to one value needs no program. In other cells, objects further away than the cell's highest level
// do not matter.
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

  float first = kNone;  // scene units; distances up to this one are exact
  // Maximum of `cap`, scene units. Outside the box [lo, hi] of the bounded parts, a distance is capped at half of the
  // way to the box, measured along the axis on which that way is longest. The cap is at least `first` and at most
  // `most`. So the bounded parts do not matter where they are far.
  float most = kNone;
  std::array<float, 3> lo{}, hi{};

  bool used() const { return first < kNone; }

  // Returns the largest level that is not above `distance`. Distances up to `first`, infinity and NaN are returned
  // unchanged.
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

  // Returns the cap at a point, infinity in the box [lo, hi].
  float cap(float x, float y, float z) const {
    return cap_at(std::max({lo[0] - x, x - hi[0], lo[1] - y, y - hi[1], lo[2] - z, z - hi[2]}));
  }
  // Returns the largest cap in the box [from, to], infinity if that box meets [lo, hi].
  float cap(const std::array<float, 3>& from, const std::array<float, 3>& to) const {
    float away = -kNone, nearest = -kNone;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      away = std::max({away, lo[axis] - from[axis], to[axis] - hi[axis]});
      nearest = std::max({nearest, lo[axis] - to[axis], from[axis] - hi[axis]});
    }
    return nearest > 0 ? cap_at(away) : kNone;
  }

  // Returns the rounded value of a distance at the point (x, y, z).
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
