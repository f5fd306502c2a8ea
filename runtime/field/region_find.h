// Finding the leaves of many points in the octree of regions, a lane a point.
// Tested by: tests/runtime/field/regions_test.cpp
#pragma once

#include <cstddef>
#include <cstdint>

#include "vm/interpret/evaluate.h"

namespace fathom::runtime {

// An octree as the lanes see it (runtime/field/regions.h says what the words mean).
struct RegionTree {
  // Pairs: a float's bits, then kind and payload. The first are those of the cells of grid_level, [z][y][x].
  const std::uint32_t* nodes;
  float lo[3];        // the root's corner, scene units
  float size, scale;  // the root's edge, scene units; finest cells per scene unit
  int levels, grid_level;
  bool beyond_cache;  // a core's own cache does not hold the scene's regions
};

inline constexpr std::size_t kMostPoints = 768;  // found together: as many as a thread moves on at once (lane_rows.h)

inline constexpr std::uint32_t kOutside = 0xffffffff;      // in place of a leaf's word
inline constexpr std::uint32_t kFirstNear = 0x80000000u;   // words below are inner cells' and far leaves'
inline constexpr std::uint32_t kRefPayload = 0x3fffffffu;  // of a leaf's word: without its kind

// Points that are in no far leaf, in their order; a multiple of 16 long, and 16 more.
struct NearPoints {
  std::uint32_t* point;  // its number
  std::uint32_t* ref;    // of the leaf it is in, or kOutside
  float* limit;          // of the leaf
};

struct FoundPoints {
  std::size_t near;
  bool outside;  // whether any of those are outside the root
};

// distance[i] of points in far leaves is the leaf's, of the others anything; and which the others are. It is padded
// to a multiple of 16.
FoundPoints find_regions(const RegionTree& tree, vm::Points points, std::size_t count, float* distance,
                         const NearPoints& near);

}  // namespace fathom::runtime
