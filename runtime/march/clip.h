// Clips rays to a box on their way into a marcher, as many at once as a register of doubles holds.
//
// By slabs: Kay and Kajiya, "Ray Tracing Complex Scenes", 1986. Not a public header: march.h is. Tested by:
// tests/runtime/march/clip_test.cpp
#pragma once

#include <cstddef>
#include <cstdint>

#include "compiler/geometry/box.h"
#include "runtime/march/ray.h"

namespace fathom::runtime {

// Result of clipping a ray: some of the ray is within the box, or the ray passes the box, or the ray is invalid (a
// direction without length, NaN, or an infinite origin or direction).
enum class ClipResult : std::uint8_t { Within, Past, Invalid };

// Rays as a structure of arrays, at most kCapacity of them.
struct RayBlock {
  static constexpr std::size_t kCapacity = 1024;
  static constexpr std::size_t kPadded = kCapacity + 8;  // a register may begin at the last ray

  std::size_t count = 0;
  double origin[3][kPadded] = {};  // [axis][ray]; scene units
  double direction[3][kPadded] = {};
  double length[kPadded] = {};  // from the origin; after clipping, of the part within the box
  // Before clipping: Ray::clear. After: distance from the ray's origin to the start of the part within the box.
  double entry[kPadded] = {};
  double result[kPadded] = {};  // after clipping: a Clip
  float slope[kCapacity];
  std::int8_t side[kCapacity];
  std::uint32_t id[kCapacity];
  std::uint32_t leaves[kPadded];

  void push(std::uint32_t ray_id, const Ray& ray) {
    const std::size_t i = count++;
    for (int axis = 0; axis < 3; ++axis) {
      origin[axis][i] = ray.origin[axis];
      direction[axis][i] = ray.direction[axis];
    }
    length[i] = ray.t_max;
    entry[i] = ray.clear;
    slope[i] = ray.slope;
    side[i] = static_cast<std::int8_t>(ray.side);
    id[i] = ray_id;
    leaves[i] = ray.leaves;
  }
  // Adds the part of a ray from `begin` to `end`, distances from its origin. `side` is known.
  void push_from(std::uint32_t ray_id, glm::dvec3 from, glm::dvec3 along, double begin, double end, int known_side) {
    push(ray_id, {from, along, end, known_side});
    entry[count - 1] = begin;
  }
  glm::dvec3 origin_of(std::size_t i) const { return {origin[0][i], origin[1][i], origin[2][i]}; }
  glm::dvec3 direction_of(std::size_t i) const { return {direction[0][i], direction[1][i], direction[2][i]}; }
  // Replaces ray `to` by a later one.
  void move(std::size_t from, std::size_t to) {
    for (int axis = 0; axis < 3; ++axis) {
      origin[axis][to] = origin[axis][from];
      direction[axis][to] = direction[axis][from];
    }
    length[to] = length[from], entry[to] = entry[from], result[to] = result[from];
    slope[to] = slope[from], side[to] = side[from], id[to] = id[from], leaves[to] = leaves[from];
  }
  // Only after clipping.
  ClipResult clip_result(std::size_t i) const { return static_cast<ClipResult>(result[i]); }
};

// Clips the rays from `first` on. Directions become unit vectors, except that a unit vector to float precision stays
// as it is. Origins move to where the ray enters the box, or to the end of its clear length if that is further on. A
// ray whose origin moved and whose side is not known starts outside (side 1). Lengths end where the ray leaves the
// box, or at `far`.
void clip(RayBlock& rays, std::size_t first, const compiler::Box& box, double far);

}  // namespace fathom::runtime
