// The budget for building the octree of regions (runtime/field/region_builder.h): limits, and the amounts used so
// far. All threads add to the amounts, and the order of their additions changes nothing.
// Tested by: tests/runtime/field/regions_test.cpp
#pragma once

#include <atomic>
#include <cstddef>

namespace fathom::runtime {

struct RegionBudget {
  // Memory for building, in units of the memory that the regions may take: for cutting programs, and as much for the
  // cells still to be split.
  static constexpr std::size_t kBuildShare = 2;

  std::size_t memory;                          // bytes that the regions may take
  std::size_t max_work;                        // instructions that this attempt may evaluate by intervals
  std::atomic<std::size_t> bytes = 0;          // of the regions built so far
  std::atomic<std::size_t> pending_bytes = 0;  // of the parts of cells left for other threads, at this level
  std::atomic<std::size_t> work = 0;           // instructions evaluated by intervals so far, in this attempt
  std::atomic<bool> interrupted = false;

  // Bytes available for building.
  std::size_t build_memory() const { return kBuildShare * memory; }
  bool is_spent() const { return bytes > memory || pending_bytes > build_memory() || work > max_work || interrupted; }
};

}  // namespace fathom::runtime
