// Finding the leaves of many points in the octree of regions, a lane a point.
// Tested by: tests/runtime/regions_test.cpp
#pragma once

#include <cstddef>
#include <cstdint>

#include "vm/evaluate.h"

namespace fathom::runtime {

// An octree as the lanes see it (runtime/regions.h says what the words mean).
struct RegionTree {
  const std::uint32_t* grid;   // [z][y][x] of the cells of grid_level
  const std::uint32_t* nodes;  // pairs: a float's bits, then kind and payload
  float lo[3];                 // the root's corner, scene units
  float size, scale;           // the root's edge, scene units; finest cells per scene unit
  float lipschitz;
  float far;  // the least value in a far cell, in edges of it
  int levels, grid_level;
};

inline constexpr std::uint32_t kOutside = 0xffffffff;  // in place of a leaf's word

// refs[i] and values[i] of the leaf that point i is in, or kOutside; where it is far, distance[i], too. All arrays
// are padded to a multiple of 16.
void find_regions(const RegionTree& tree, vm::Points points, std::size_t count, std::uint32_t* refs, float* values,
                  float* distance);

}  // namespace fathom::runtime
