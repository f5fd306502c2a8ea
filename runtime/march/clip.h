// Rays on their way into a marcher: each is cut to the stretch of it within a box, as many at once as a register of
// doubles holds.
//
// By slabs: Kay and Kajiya, "Ray Tracing Complex Scenes", 1986. Not a public header: march.h is. Tested by:
// tests/runtime/march/clip_test.cpp
#pragma once

#include <cstddef>
#include <cstdint>

#include "compiler/geometry/box.h"
#include "runtime/march/ray.h"

namespace fathom::runtime {

// What became of a ray that was clipped: it has a stretch within, or never comes there, or is no ray at all (no
// direction, or numbers that are not).
enum class Clip : std::uint8_t { Within, Past, Invalid };

// Rays side by side, at most kCapacity.
struct RayBlock {
  static constexpr std::size_t kCapacity = 1024;
  static constexpr std::size_t kPadded = kCapacity + 8;  // a register may begin at the last ray

  std::size_t count = 0;
  double origin[3][kPadded] = {};  // [axis][ray]; scene units
  double direction[3][kPadded] = {};
  double length[kPadded] = {};  // of the ray, from its origin
  double entry[kPadded] = {};   // what is clear; once clipped: from the ray's origin to where the stretch begins
  double fate[kPadded] = {};    // once clipped: a Clip
  float slope[kCapacity];
  std::int8_t side[kCapacity];
  std::uint32_t id[kCapacity];

  void push(std::uint32_t ray_id, const Ray& ray) {
    const std::size_t i = count++;
    for (int axis = 0; axis < 3; ++axis) {
      origin[axis][i] = ray.origin[axis];
      direction[axis][i] = ray.direction[axis];
    }
    length[i] = ray.t_max;
    entry[i] = static_cast<double>(ray.clear);
    slope[i] = ray.slope;
    side[i] = static_cast<std::int8_t>(ray.side);
    id[i] = ray_id;
  }
  // Once clipped.
  Clip what_became_of(std::size_t i) const { return static_cast<Clip>(fate[i]); }
};

// Directions become unit vectors; one that is to float precision stays as it is. Origins move to where the ray enters
// the box, or past what is clear, and are then outside (side 1) when that is further on; lengths end where it leaves
// it or at `far`. The rays from `first` on.
void clip(RayBlock& rays, std::size_t first, const compiler::Box& box, double far);

}  // namespace fathom::runtime
