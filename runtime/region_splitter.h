// Splitting the cells of the octree of regions (runtime/region_builder.h): which leaves they become.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

#include "runtime/region_builder.h"

namespace fathom::runtime {

// A cell is far when the field is at least this many half diagonals above zero all over it.
inline constexpr float kFar = 0.25f;
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

// Instructions that may be enclosed before regions are given up: scenes that cannot be cut are not worth the time.
inline constexpr std::size_t kMostWork = 100'000'000;

// Splits cells, on one thread.
class RegionBuilder::Splitter {
 public:
  explicit Splitter(RegionBuilder& builder);

  // Makes the cell's descendants, into an empty piece.
  void run(const Cell& cell, Piece& piece);

 private:
  using Node = Regions::Node;
  using Kind = Regions::Kind;
  using Place = std::array<std::uint32_t, 3>;  // in cells of a level
  using Children = std::array<bool, 8>;        // those that are leaves already
  using Parts = std::array<vm::Part, 8>;

  // Makes the eight children, at nodes[first] and on, of a cell; those that are no leaves are split in turn.
  void split(const vm::Part& part, const Place& at, int level, float limit, int idle_so_far, std::uint32_t first);
  // The parts of the children that are no leaves yet.
  void cut(float limit, const Children& done, Parts& parts);
  // Leaves of those whose parts for the limit are short enough.
  void make_leaves(float limit, int level, std::uint32_t first, Children& done, Parts& parts);
  BoxArrays children_of(const Place& at, int level) const;
  // What a piece's leaves take, but for the nodes.
  static std::size_t bytes_of(const Piece& piece);
  // Children that nothing is near.
  void find_far(const vm::Part& part, const BoxArrays& boxes, float half_diagonal, int level, float limit,
                std::uint32_t first, Children& children);
  // False when the part is too long for a leaf, and it need not always be one.
  bool make_leaf(vm::Part& part, bool always, std::uint32_t choices, int level, float limit, std::uint32_t node);
  // The program that was packed last, or an equal one before it.
  std::uint32_t intern(std::uint32_t start);

  RegionBuilder& builder_;
  const Regions& regions_;
  const int levels_;
  const std::uint32_t leaf_choices_;
  vm::Specialiser specialiser_;
  vm::Workspace workspace_;
  std::vector<Parts> parts_;  // [level]
  Piece* piece_ = nullptr;
};

}  // namespace fathom::runtime
