// Finding the leaves of many points in the octree of regions, a lane a point.
// Tested by: tests/runtime/regions_test.cpp
#pragma once

#include <cstddef>
#include <cstdint>

#include "vm/evaluate.h"

namespace fathom::runtime {

// An octree as the lanes see it (runtime/regions.h says what the words mean).
struct RegionTree {
  // Pairs: a float's bits, then kind and payload. The first are those of the cells of grid_level, [z][y][x].
  const std::uint32_t* nodes;
  float lo[3];        // the root's corner, scene units
  float size, scale;  // the root's edge, scene units; finest cells per scene unit
  float lipschitz;
  float far;  // the least value in a far cell, in edges of it
  int levels, grid_level;
};

inline constexpr std::uint32_t kOutside = 0xffffffff;     // in place of a leaf's word
inline constexpr std::uint32_t kFirstNear = 0x80000000u;  // words below are inner cells' and far leaves'

// Points that are in no far leaf, in the order of the points; a multiple of 16 long, and 16 more.
struct NearPoints {
  std::uint32_t* point;
  std::uint32_t* ref;  // of the leaf it is in, or kOutside
  float* limit;        // of the leaf
};

// distance[i] of points in far leaves, of the others anything; and which the others are: how many. `distance` is
// padded to a multiple of 16.
std::size_t find_regions(const RegionTree& tree, vm::Points points, std::size_t count, float* distance,
                         const NearPoints& near);

}  // namespace fathom::runtime
