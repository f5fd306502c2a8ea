// Splits the cells of the octree of regions (runtime/field/regions.h) into leaves.
// Tested by: tests/runtime/field/regions_test.cpp
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "runtime/field/far_levels.h"
#include "runtime/field/region_budget.h"
#include "runtime/field/region_find.h"
#include "runtime/field/regions.h"
#include "vm/prune/program_template.h"
#include "vm/prune/specialise.h"

namespace fathom::runtime {

// Margin around a cell, in edges of the root, for the rounding in the search for a point's cell.
inline constexpr double kCellMargin = 0x1p-20;

inline Regions::Node make_node(Regions::Kind kind, std::uint32_t payload, float value) {
  return {value, static_cast<std::uint32_t>(kind) << 30 | payload};
}

// The coordinates of up to kEnclosedBoxes boxes.
struct BoxArrays {
  alignas(64) float lo[3][vm::kEnclosedBoxes], hi[3][vm::kEnclosedBoxes];
  vm::Boxes view() const { return {{lo[0], lo[1], lo[2]}, {hi[0], hi[1], hi[2]}}; }
};

// Error of f32, relative to the size of the numbers: six times that of a whole field (kDistanceError), because the
// splitter compares operands within a field.
inline constexpr float kCellError = 0x1p-18f;

// A cell to be split, and the part of the program that matters in the cell for values up to `limit`.
struct RegionCell {
  std::array<std::uint32_t, 3> at;  // position, in cells of its level
  int level;
  float limit;
  int unshortened;  // number of levels in a row at which its part did not get shorter
  vm::PrunedProgram part;
  std::uint32_t node;  // index of its node
};

// The result of one thread for a cell. nodes[0..8) are the cell's children, and indices are those of the piece.
struct RegionPiece {
  std::vector<Regions::Node> nodes;
  vm::ProgramTemplates program_templates;
  std::vector<std::uint32_t> pool;
  std::vector<std::uint32_t> programs;  // where the programs begin in the pool, in ascending order
  std::vector<std::uint32_t> slots;     // hash table of the programs: index + 1, or 0
  std::vector<RegionCell> pending;      // left for other threads
  Regions::Summary summary;
};

// The rules for splitting, the same for all cells.
struct SplitRules {
  const RegionOptions& options;
  const RegionTree& tree;  // only its root and the number of its levels are used
  const FarLevels& far;
  const vm::Constants& constants;
  std::uint32_t choice_factor;  // factor on the choices that a leaf may have
};

// kLeafChoices: maximum number of choices in the program of a leaf of normal length. A cell becomes a leaf after more
// than kMaxIdle levels in a row at which its part kept at least a share kShorterPart of its length.
inline constexpr std::uint32_t kLeafChoices = 4;
inline constexpr double kShorterPart = 0.9;
inline constexpr int kMaxIdle = 2;

// Splits cells, on one thread.
class RegionSplitter {
 public:
  RegionSplitter(const SplitRules& rules, RegionBudget& budget);

  // Makes the cell's descendants, in an empty piece.
  void run(const RegionCell& cell, RegionPiece& piece);

  // Facts about some cells of a level: [cell] true if all its values round to one; number of choices that its part
  // has.
  struct CellFacts {
    std::array<bool, vm::kEnclosedBoxes> far;
    std::array<std::uint32_t, vm::kEnclosedBoxes> choices;
  };
  // Bounds the cells around `points`, which are in units of the root's edge, from its corner.
  CellFacts bound_cells(const vm::PrunedProgram& part, const std::array<glm::dvec3, vm::kEnclosedBoxes>& points,
                        int level);

 private:
  using Node = Regions::Node;
  using Kind = Regions::Kind;
  using CellIndex = std::array<std::uint32_t, 3>;  // position of a cell, in cells of its level
  using Children = std::array<bool, 8>;        // true for a child that is already a leaf
  using Parts = std::array<vm::PrunedProgram, 8>;
  using Limits = std::array<float, 8>;

  // Makes the eight children of a cell, at nodes[first] and on, and splits the children that are not leaves.
  void split(const vm::PrunedProgram& part, const CellIndex& at, int level, float limit, int unshortened_levels,
             std::uint32_t first);
  // Makes the child a leaf, leaves it for other threads, or splits it.
  void place_child(vm::PrunedProgram& child, double shorter, const CellIndex& at, int level, float limit,
                   int unshortened_levels, std::uint32_t node);
  // Returns the limit up to which each child's values matter.
  Limits limits_of(const BoxArrays& boxes, float limit) const;
  // Makes far leaves of the children in which all values round to one. Returns these children.
  Children make_far(const Limits& limits, std::uint32_t first);
  // Makes the parts of the other children, and leaves of the children whose parts are short enough.
  void make_parts(const Limits& limits, int level, std::uint32_t first, Children& done, Parts& parts);
  // Returns the boxes of a cell's children. Also sets error_.
  BoxArrays children_of(const CellIndex& at, int level);
  // Returns the boxes of cells of a level. Also sets error_.
  BoxArrays boxes_of(const std::array<CellIndex, vm::kEnclosedBoxes>& cells, int level);
  // True if all values in box i, which has this limit, round to one.
  bool is_far(std::size_t i, float limit) const { return specialiser_.lo(i) * (1 - kCellError) - error_ >= limit; }
  // Returns the limit up to which values in box i matter.
  float limit_of(const BoxArrays& boxes, std::size_t i, float limit) const;
  // Returns the bytes of a piece's leaves, without the nodes.
  static std::size_t bytes_of(const RegionPiece& piece);
  void make_leaf(const vm::PrunedProgram& part, float limit, std::uint32_t node);
  // Returns the place of the program packed last, or of an equal program before it, which then replaces it.
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
  float error_ = 0;           // of f32, in the cell that is being split
  RegionPiece* piece_ = nullptr;
};

}  // namespace fathom::runtime
