// Finds the leaves of many points in the octree of regions, one point per lane.
// Tested by: tests/runtime/field/regions_test.cpp
#pragma once

#include <cstddef>
#include <cstdint>

#include "vm/interpret/evaluate.h"

namespace fathom::runtime {

// The octree as the lanes read it (runtime/field/regions.h defines the words).
struct RegionTree {
  // Two words per node: the bits of its value, then kind and payload. The nodes of the cells of grid_level come
  // first, in the order [z][y][x].
  const std::uint32_t* nodes;
  float lo[3];        // the root's corner, scene units
  float size, scale;  // the root's edge, scene units; finest cells per scene unit
  int levels, grid_level;
  bool beyond_cache;  // true if a core's own cache cannot hold the scene's regions
};

// Maximum number of points per call, as many as a thread advances at once (lane_rows.h).
inline constexpr std::size_t kMaxPoints = 768;

inline constexpr std::uint32_t kOutside = 0xffffffff;      // in place of a leaf's word, for points outside the root
inline constexpr std::uint32_t kFirstNear = 0x80000000u;   // smaller words are those of inner cells and far leaves
inline constexpr std::uint32_t kRefPayload = 0x3fffffffu;  // mask of the payload in a leaf's word, below the kind

// The points that are in no far leaf, in ascending order. The length of the arrays is a multiple of 16, plus 16.
struct NearPoints {
  std::uint32_t* point;  // index of the point
  std::uint32_t* ref;    // word of the point's leaf, or kOutside
  float* limit;          // value of the point's leaf
};

struct LookupResult {
  std::size_t near;
  bool outside;  // true if any of the near points is outside the root
};

// Sets distance[i] to the leaf's value for points in far leaves, and to anything for other points, which are written
// to `near`. The array of distances is padded to a multiple of 16.
LookupResult find_regions(const RegionTree& tree, vm::Points points, std::size_t count, float* distance,
                          const NearPoints& near);

}  // namespace fathom::runtime
