// Splitting the cells of the octree of regions (runtime/field/regions.h): which leaves they become.
// Tested by: tests/runtime/field/regions_test.cpp
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "runtime/field/far_levels.h"
#include "runtime/field/region_budget.h"
#include "runtime/field/region_find.h"
#include "runtime/field/regions.h"
#include "vm/prune/skeleton.h"
#include "vm/prune/specialise.h"

namespace fathom::runtime {

// Of the root's edge: how much larger a cell is taken than it is, for the rounding that finds a point's cell.
inline constexpr double kCellMargin = 0x1p-20;

inline Regions::Node make_node(Regions::Kind kind, std::uint32_t payload, float value) {
  return {value, static_cast<std::uint32_t>(kind) << 30 | payload};
}

// The coordinates of up to kEnclosedBoxes boxes.
struct BoxArrays {
  alignas(64) float lo[3][vm::kEnclosedBoxes], hi[3][vm::kEnclosedBoxes];
  vm::Boxes view() const { return {{lo[0], lo[1], lo[2]}, {hi[0], hi[1], hi[2]}}; }
};

// What f32 may be off by, relative to the size of the numbers: six times what it is for a whole field
// (kDistanceError), since operands within one are compared.
inline constexpr float kCellError = 0x1p-18f;

// A cell that is to be split, and what of the program matters in it where its value is at most `limit`.
struct RegionCell {
  std::array<std::uint32_t, 3> at;  // in cells of its level
  int level;
  float limit;
  int idle;  // levels at which its part did not get shorter
  vm::Part part;
  std::uint32_t node;  // that it is
};

// What one thread has made of a cell: nodes[0..8) are its children, and numbers are its own.
struct RegionPiece {
  std::vector<Regions::Node> nodes;
  vm::Skeletons skeletons;
  std::vector<std::uint32_t> pool;
  std::vector<std::uint32_t> programs;  // where they begin in the pool, one behind the other
  std::vector<std::uint32_t> slots;     // a hash table of them: number + 1, or 0
  std::vector<RegionCell> pending;      // left for other threads
  Regions::Facts facts;
};

// All cells are split by the same rules.
struct SplitRules {
  const RegionOptions& options;
  const RegionTree& tree;  // its root and the number of its levels
  const FarLevels& far;
  const vm::Constants& constants;
  std::uint32_t longer;  // how much longer than they should be leaves are
};

// Splits cells, on one thread.
class RegionSplitter {
 public:
  RegionSplitter(const SplitRules& rules, RegionBudget& budget);

  // Makes the cell's descendants, into an empty piece.
  void run(const RegionCell& cell, RegionPiece& piece);

 private:
  using Node = Regions::Node;
  using Kind = Regions::Kind;
  using Place = std::array<std::uint32_t, 3>;  // in cells of a level
  using Children = std::array<bool, 8>;        // those that are leaves already
  using Parts = std::array<vm::Part, 8>;
  using Limits = std::array<float, 8>;

  // Makes the eight children, at nodes[first] and on, of a cell; those that are no leaves are split in turn.
  void split(const vm::Part& part, const Place& at, int level, float limit, int idle_so_far, std::uint32_t first);
  // Takes the child where it is left for other threads.
  void go_on(vm::Part& child, double shorter, const Place& at, int level, float limit, int idle_so_far,
             std::uint32_t node);
  // Up to where each child's values matter.
  Limits limits_of(const BoxArrays& boxes, float limit) const;
  // Leaves of those children in which all values round to one.
  Children make_far(const Limits& limits, std::uint32_t first);
  // The parts of the others; leaves of those that are short enough.
  void make_parts(const Limits& limits, int level, std::uint32_t first, Children& done, Parts& parts);
  // Sets error_, too.
  BoxArrays children_of(const Place& at, int level);
  // What a piece's leaves take, but for the nodes.
  static std::size_t bytes_of(const RegionPiece& piece);
  void make_leaf(const vm::Part& part, float limit, std::uint32_t node);
  // The program that was packed last, or an equal one before it.
  std::uint32_t intern(std::uint32_t start);
  std::span<const std::uint32_t> program(std::size_t number) const;
  std::size_t slot_of(std::span<const std::uint32_t> program) const;
  void grow_slots();

  const SplitRules rules_;
  RegionBudget& budget_;
  const int levels_;
  const std::uint32_t leaf_choices_;
  vm::Specialiser specialiser_;
  vm::Workspace workspace_;
  std::vector<Parts> parts_;  // [level]
  float error_ = 0;           // of f32, in the cell that is split
  RegionPiece* piece_ = nullptr;
};

}  // namespace fathom::runtime
