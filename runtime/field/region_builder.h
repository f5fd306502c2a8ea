// Builds the octree of regions (runtime/field/regions.h): the same tree for any number of threads. Whether it fits
// what the options allow is decided of sums over all cells, which no order of theirs changes.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <vector>

#include "runtime/field/region_plan.h"
#include "runtime/field/regions.h"
#include "vm/specialise.h"

namespace fathom::runtime {

class RegionBuilder {
 public:
  RegionBuilder(const vm::Code& program, const RegionPlan& plan, const RegionOptions& options);

  // Nothing when what the options allow does not suffice, or they interrupt.
  std::shared_ptr<const Regions> build();

 private:
  // A cell that is to be split, and what of the program matters in it where its value is at most `limit`.
  struct Cell {
    std::array<std::uint32_t, 3> at;  // in cells of its level
    int level;
    float limit;
    int idle;  // levels at which its part did not get shorter
    vm::Part part;
    std::uint32_t node;  // that it is
  };
  // What one thread has made of a cell: nodes[0..8) are its children, and numbers are its own.
  struct Piece {
    std::vector<Regions::Node> nodes;
    vm::Skeletons skeletons;
    std::vector<std::uint32_t> pool;
    std::vector<std::uint32_t> programs;  // where they begin in the pool, one behind the other
    std::vector<std::uint32_t> slots;     // a hash table of them: number + 1, or 0
    std::vector<Cell> pending;            // left for other threads
    Regions::Facts facts;
  };
  class Splitter;

  bool split_root();
  void split_all(std::vector<Cell> cells);
  void append_all(std::vector<Cell>& cells, std::vector<Piece>& pieces);
  std::uint32_t append(Piece& piece);
  bool is_in_vain() const;
  std::size_t threads_for(const std::vector<Cell>& cells) const;
  void close_outside();
  void choose_grid();
  void make_grid();
  void count_bytes();

  RegionOptions options_;
  RegionPlan plan_;
  vm::Code program_;
  std::uint32_t longer_ = 1;                    // how much longer than they should be leaves are, to fit the memory
  std::atomic<std::size_t> bytes_ = 0;          // of what is built so far
  std::atomic<std::size_t> pending_bytes_ = 0;  // of the parts of cells left for other threads, at this level
  std::atomic<std::size_t> work_ = 0;           // instructions enclosed so far, in this attempt
  std::size_t most_work_;
  std::atomic<bool> interrupted_ = false;
  std::shared_ptr<Regions> regions_;
};

}  // namespace fathom::runtime
