// Builds the octree of regions (runtime/field/regions.h): the same tree for any number of threads. Whether it fits
// what the options allow is decided of sums over all cells, which no order of theirs changes.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "runtime/field/region_budget.h"
#include "runtime/field/region_plan.h"
#include "runtime/field/region_splitter.h"
#include "runtime/field/regions.h"

namespace fathom::runtime {

class RegionBuilder {
 public:
  RegionBuilder(const vm::Code& program, const RegionPlan& plan, const RegionOptions& options);

  // Nothing when what the options allow does not suffice, or they interrupt.
  std::shared_ptr<const Regions> build();

 private:
  bool split_root();
  void split_all(std::vector<RegionCell> cells);
  void append_all(std::vector<RegionCell>& cells, std::vector<RegionPiece>& pieces);
  std::uint32_t append(RegionPiece& piece);
  std::size_t threads_for(const std::vector<RegionCell>& cells) const;
  void close_outside();
  void choose_grid();
  void make_grid();
  void count_bytes();

  RegionOptions options_;
  RegionPlan plan_;
  vm::Code program_;
  RegionBudget budget_;
  std::uint32_t longer_ = 1;  // how much longer than they should be leaves are, to fit the memory
  std::shared_ptr<Regions> regions_;
};

}  // namespace fathom::runtime
