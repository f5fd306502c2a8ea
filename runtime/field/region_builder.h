// Builds the octree of regions (runtime/field/regions.h): the same tree for any number of threads. Sums over all
// cells decide if the tree fits the limits of the options, and no order of the cells changes the sums.
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

  // Returns null if the limits of the options do not suffice, or if `interrupted` returns true.
  std::shared_ptr<const Regions> build();

 private:
  bool split_root();
  double max_work(double forecast) const;
  void split_all(std::vector<RegionCell> cells);
  void append_all(std::vector<RegionCell>& cells, std::vector<RegionPiece>& pieces);
  std::uint32_t append(RegionPiece& piece);
  int threads_for(const std::vector<RegionCell>& cells) const;
  void close_outside();
  void choose_grid();
  void make_grid();
  void count_bytes();

  RegionOptions options_;
  RegionPlan plan_;
  vm::Code program_;
  RegionBudget budget_;
  std::uint32_t choice_factor_ =
      1;  // factor on the choices that a leaf may have, raised until the regions fit the budget
  std::shared_ptr<Regions> regions_;
};

}  // namespace fathom::runtime
