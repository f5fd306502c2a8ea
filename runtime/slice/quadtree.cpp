// Evaluates a slice by a quadtree. If only signs are needed, tiles that are solid or empty throughout are filled at
// once. In other tiles each level prunes the program (vm/prune/specialise.h), and then the pixels are evaluated.
//
// Source: Duff, "Interval arithmetic and recursive subdivision for implicit functions and constructive solid
// geometry", 1992; Keeter, "Massively Parallel Rendering of Complex Closed-Form Implicit Surfaces", 2020.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "runtime/slice/slice.h"
#include "vm/program/parallel_for.h"
#include "vm/prune/specialise.h"

namespace fathom::runtime {
namespace {

// Edges of the tiles of each level, pixels. A tile holds kTilesAcross * kTilesAcross tiles of the next level.
constexpr int kEdges[] = {256, 64, 16};
constexpr int kLevels = 3, kTilesAcross = 4;
static_assert(kTilesAcross * kTilesAcross == vm::kEnclosedBoxes);
// Values of a program with fewer choices take no longer without pruning. Signs always gain from filled tiles.
constexpr std::size_t kMinChoices = 24;

struct Tile {
  int x, y;  // first pixel
};

class QuadtreeWorker {
 public:
  QuadtreeWorker(const Slice& slice, SliceValues wanted, bool prunes, std::vector<float>& field)
      : slice_(slice), sign_(wanted == SliceValues::Sign), prunes_(prunes), field_(field) {
    for (int axis = 0; axis < 3; ++axis) {
      auto &columns = columns_[static_cast<std::size_t>(axis)], &rows = rows_[static_cast<std::size_t>(axis)];
      for (int x = 0; x < slice.width; ++x) columns.push_back(static_cast<float>(slice.point(x, 0)[axis]));
      for (int y = 0; y < slice.height; ++y) rows.push_back(static_cast<float>(slice.point(0, y)[axis]));
      by_column_[static_cast<std::size_t>(axis)] = columns.front() != columns.back();
    }
  }

  // Evaluates the sixteen tiles of a level that start at `first`, as far as the image goes, or only tile `only`.
  void run(const vm::PrunedProgram& part, Tile first, int level, std::size_t only = vm::kEnclosedBoxes) {
    const int edge = kEdges[level];
    vm::Specialiser& specialiser = specialisers_[static_cast<std::size_t>(level)];
    if (prunes_) {
      set_boxes(first, edge);
      specialiser.enclose_choices(part, boxes(), workspace_);
      const float infinity = std::numeric_limits<float>::infinity();
      specialiser.resolve(sign_ ? 0 : -infinity, sign_ ? 0 : infinity);
    }
    for (std::size_t i = 0; i < vm::kEnclosedBoxes; ++i) {
      const Tile tile = tile_of(first, edge, i);
      if (tile.x >= slice_.width || tile.y >= slice_.height || (only < vm::kEnclosedBoxes && i != only)) continue;
      if (prunes_ && sign_ && (specialiser.lo(i) > 0 || specialiser.hi(i) < 0)) {
        fill(tile, edge, specialiser.lo(i) > 0 ? 1.0f : -1.0f);
        continue;
      }
      const vm::PrunedProgram& child = prunes_ ? cut(part, specialiser, i, level) : part;
      if (level + 1 < kLevels) {
        run(child, tile, level + 1);
      } else {
        evaluate(child, tile);
      }
    }
  }

 private:
  // Returns the part of `part` that matters in box i, or `part` itself if a smaller part costs more than it saves.
  const vm::PrunedProgram& cut(const vm::PrunedProgram& part, vm::Specialiser& specialiser, std::size_t i,
                               int level) {
    constexpr std::uint32_t kCheap = 16;  // choices
    if (5 * (specialiser.choices_left(i) + kCheap) > 4 * part.choices) return part;
    vm::PrunedProgram& child = parts_[static_cast<std::size_t>(level)];
    specialiser.prune(i, child);
    return child;
  }
  static Tile tile_of(Tile first, int edge, std::size_t i) {
    return {first.x + edge * static_cast<int>(i % kTilesAcross), first.y + edge * static_cast<int>(i / kTilesAcross)};
  }
  vm::Boxes boxes() const { return {{lo_[0], lo_[1], lo_[2]}, {hi_[0], hi_[1], hi_[2]}}; }

  // Sets the tiles' boxes, from the first pixel's centre to the last pixel's, in the coordinates of evaluation.
  void set_boxes(Tile first, int edge) {
    for (std::size_t i = 0; i < vm::kEnclosedBoxes; ++i) {
      const Tile tile = tile_of(first, edge, i);
      const int x0 = std::min(tile.x, slice_.width - 1), y0 = std::min(tile.y, slice_.height - 1);
      const int x1 = std::min(tile.x + edge, slice_.width) - 1, y1 = std::min(tile.y + edge, slice_.height) - 1;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const float a = place(axis, x0, y0), b = place(axis, std::max(x0, x1), std::max(y0, y1));
        lo_[axis][i] = std::min(a, b), hi_[axis][i] = std::max(a, b);
      }
    }
  }

  // Returns a coordinate of a pixel's centre.
  float place(std::size_t axis, int x, int y) const {
    return by_column_[axis] ? columns_[axis][static_cast<std::size_t>(x)] : rows_[axis][static_cast<std::size_t>(y)];
  }
  float* row(int y) { return field_.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(slice_.width); }

  void fill(Tile tile, int edge, float value) {
    const int x1 = std::min(tile.x + edge, slice_.width), y1 = std::min(tile.y + edge, slice_.height);
    for (int y = tile.y; y < y1; ++y) std::fill(row(y) + tile.x, row(y) + x1, value);
  }

  void evaluate(const vm::PrunedProgram& part, Tile tile) {
    constexpr int kFinestEdge = kEdges[kLevels - 1];
    const int x1 = std::min(tile.x + kFinestEdge, slice_.width), y1 = std::min(tile.y + kFinestEdge, slice_.height);
    alignas(64) std::array<std::array<float, kFinestEdge * kFinestEdge>, 3> points;
    alignas(64) std::array<float, kFinestEdge * kFinestEdge> values;
    std::size_t count = 0;
    for (int y = tile.y; y < y1; ++y, count += static_cast<std::size_t>(x1 - tile.x)) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        float* to = points[axis].data() + count;
        if (by_column_[axis]) {
          std::copy(columns_[axis].data() + tile.x, columns_[axis].data() + x1, to);
        } else {
          std::fill(to, to + (x1 - tile.x), rows_[axis][static_cast<std::size_t>(y)]);
        }
      }
    }
    vm::evaluate_distance(part, {points[0].data(), points[1].data(), points[2].data()}, count, values.data(),
                          workspace_);
    const float* from = values.data();
    for (int y = tile.y; y < y1; ++y, from += x1 - tile.x) std::copy_n(from, x1 - tile.x, row(y) + tile.x);
  }

  const Slice& slice_;
  const bool sign_, prunes_;
  std::vector<float>& field_;
  // [axis] coordinates of the first row's pixels, of the first column's pixels, and true if the coordinate changes
  // along a row.
  std::array<std::vector<float>, 3> columns_, rows_;
  std::array<bool, 3> by_column_{};
  vm::Workspace workspace_;
  std::array<vm::Specialiser, kLevels> specialisers_;
  std::array<vm::PrunedProgram, kLevels> parts_;
  alignas(64) float lo_[3][vm::kEnclosedBoxes], hi_[3][vm::kEnclosedBoxes];
};

}  // namespace

std::vector<float> evaluate_slice(const vm::VerifiedProgram& distance, const Slice& slice, int threads,
                                  SliceValues wanted) {
  std::vector<float> field(static_cast<std::size_t>(slice.width) * static_cast<std::size_t>(slice.height));
  vm::DefUseGraph graph;
  const bool prunes = graph.read(distance) && (wanted == SliceValues::Sign || graph.choices().size() >= kMinChoices);
  const vm::PrunedProgram part = vm::whole(distance);
  const int level = prunes ? 0 : kLevels - 1, step = kEdges[level] * kTilesAcross;
  const int columns = (slice.width + step - 1) / step, rows = (slice.height + step - 1) / step;
  // Several threads take the largest tiles one by one, although enclosing sixteen tiles costs as much as enclosing
  // one. A single thread takes all sixteen at once.
  const bool one_by_one = prunes && threads > 1;
  const std::size_t turns = one_by_one ? vm::kEnclosedBoxes : 1;
  parallel_for(
      threads, static_cast<std::size_t>(columns * rows) * turns,
      [&] { return QuadtreeWorker(slice, wanted, prunes, field); },
      [&](QuadtreeWorker& worker, std::size_t i) {
        const int block = static_cast<int>(i / turns);
        worker.run(part, {block % columns * step, block / columns * step}, level,
                   one_by_one ? i % turns : vm::kEnclosedBoxes);
      });
  return field;
}

}  // namespace fathom::runtime
