// The budget of building the octree of regions (runtime/field/region_builder.h): what it may take, and what it has
// taken so far. All threads add to the sums; which of them adds first changes nothing.
// Tested by: tests/runtime/field/regions_test.cpp
#pragma once

#include <atomic>
#include <cstddef>

namespace fathom::runtime {

struct RegionBudget {
  // How many times what regions may take is there to build them: for cutting programs, and for cells to be split.
  static constexpr std::size_t kBuildShare = 2;

  std::size_t memory;                          // bytes that the regions may take
  std::size_t most_work;                       // instructions that may be enclosed in this attempt
  std::atomic<std::size_t> bytes = 0;          // of what is built so far
  std::atomic<std::size_t> pending_bytes = 0;  // of the parts of cells left for other threads, at this level
  std::atomic<std::size_t> work = 0;           // instructions enclosed so far, in this attempt
  std::atomic<bool> interrupted = false;

  // Bytes that there are to build with.
  std::size_t build_memory() const { return kBuildShare * memory; }
  bool is_spent() const {
    return bytes > memory || pending_bytes > build_memory() || work > most_work || interrupted;
  }
};

}  // namespace fathom::runtime
