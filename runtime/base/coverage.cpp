#include "runtime/base/coverage.h"

#include <algorithm>
#include <numeric>
#include <span>
#include <utility>

namespace fathom::runtime {
namespace {

// A part of a row of pixels with equal samples: [x0, x1), and the ranges in order, none touching the next.
struct PixelColumn {
  int x0, x1;
  std::vector<SampleRange> ranges;

  bool operator==(const PixelColumn&) const = default;
};

std::vector<SampleRange> joined(std::vector<SampleRange> ranges) {
  std::sort(ranges.begin(), ranges.end(), [](SampleRange a, SampleRange b) { return a.first < b.first; });
  std::vector<SampleRange> result;
  for (const SampleRange range : ranges) {
    if (!result.empty() && result.back().last >= range.first) {
      result.back().last = std::max(result.back().last, range.last);
    } else {
      result.push_back(range);
    }
  }
  return result;
}

// Calls use(from, to, blocks) for the intervals of one axis between the blocks' sides, each with the blocks that
// contain it. Intervals in no block are left out. Begin and End give a block's sides.
template <class Begin, class End, class Use>
void sweep(std::vector<SampleBlock> blocks, const Begin& begin, const End& end, const Use& use) {
  std::vector<int> sides;
  for (const SampleBlock& block : blocks) {
    sides.push_back(begin(block));
    sides.push_back(end(block));
  }
  std::sort(sides.begin(), sides.end());
  sides.erase(std::unique(sides.begin(), sides.end()), sides.end());
  std::sort(blocks.begin(), blocks.end(),
            [&](const SampleBlock& a, const SampleBlock& b) { return begin(a) < begin(b); });
  std::vector<SampleBlock> within;
  std::size_t next = 0;
  for (std::size_t i = 0; i + 1 < sides.size(); ++i) {
    std::erase_if(within, [&](const SampleBlock& block) { return end(block) <= sides[i]; });
    for (; next < blocks.size() && begin(blocks[next]) <= sides[i]; ++next) within.push_back(blocks[next]);
    if (!within.empty()) use(sides[i], sides[i + 1], within);
  }
}

std::vector<PixelColumn> columns_of(const std::vector<SampleBlock>& row) {
  std::vector<PixelColumn> columns;
  sweep(
      row, [](const SampleBlock& block) { return block.area.x0; },
      [](const SampleBlock& block) { return block.area.x1; },
      [&](int x0, int x1, const std::vector<SampleBlock>& blocks) {
        std::vector<SampleRange> ranges;
        for (const SampleBlock& block : blocks) ranges.push_back(block.samples);
        ranges = joined(std::move(ranges));
        if (!columns.empty() && columns.back().x1 == x0 && columns.back().ranges == ranges) {
          columns.back().x1 = x1;
        } else {
          columns.push_back({x0, x1, std::move(ranges)});
        }
      });
  return columns;
}

// Adds the parts of `from` outside of `hole` to `pieces`. `hole` lies in `from`.
void cut(const SampleBlock& from, const SampleBlock& hole, std::vector<SampleBlock>& pieces) {
  const auto keep = [&](PixelRect area, SampleRange samples) {
    if (area.width() > 0 && area.height() > 0 && samples.first < samples.last) pieces.push_back({area, samples});
  };
  const PixelRect& a = from.area;
  const PixelRect& h = hole.area;
  keep({a.x0, a.y0, a.x1, h.y0}, from.samples);
  keep({a.x0, h.y0, h.x0, h.y1}, from.samples);
  keep(h, {from.samples.first, hole.samples.first});
  keep(h, {hole.samples.last, from.samples.last});
  keep({h.x1, h.y0, a.x1, h.y1}, from.samples);
  keep({a.x0, h.y1, a.x1, a.y1}, from.samples);
}

using Blocks = std::span<const SampleBlock>;

// Returns the leading blocks that have a side in common with the first block.
Blocks run_of(Blocks blocks, int PixelRect::*side) {
  std::size_t count = 1;
  while (count < blocks.size() && blocks[count].area.*side == blocks[0].area.*side) ++count;
  return blocks.first(count);
}

// True if the row's columns are in order and disjoint, touching columns differ, and the ranges of each column are in
// order and apart.
bool is_canonical_row(Blocks row) {
  Blocks before;
  while (!row.empty()) {
    const Blocks column = run_of(row, &PixelRect::x0);
    for (std::size_t i = 0; i + 1 < column.size(); ++i) {
      if (column[i].area != column[i + 1].area || column[i].samples.last >= column[i + 1].samples.first) return false;
    }
    const auto same = [](const SampleBlock& a, const SampleBlock& b) { return a.samples == b.samples; };
    if (!before.empty()) {
      const PixelRect &left = before[0].area, &right = column[0].area;
      if (left.x1 > right.x0 || left.y1 != right.y1) return false;
      const bool touch = left.x1 == right.x0;
      if (touch && std::equal(before.begin(), before.end(), column.begin(), column.end(), same)) return false;
    }
    before = column;
    row = row.subspan(column.size());
  }
  return true;
}

// True if the piece intersects neither the canonical block `at` nor any later block.
bool is_behind(const SampleBlock& piece, const SampleBlock& at) {
  const PixelRect &a = piece.area, &b = at.area;
  if (a.y1 <= b.y0) return true;
  if (a.y0 < b.y0 || a.y1 > b.y1) return false;
  return a.x1 <= b.x0 || (a.x0 >= b.x0 && a.x1 <= b.x1 && piece.samples.last <= at.samples.first);
}

// Calls use() with each of the canonical blocks that intersects `block`, in order, while use() returns true.
// Bisection skips the blocks before: rows by y1, columns by x1, ranges by their ends.
template <class Use>
void each_intersection(Blocks canonicalise, const SampleBlock& block, const Use& use) {
  const auto skip = [](Blocks from, const auto& before) {
    return from.subspan(
        static_cast<std::size_t>(std::partition_point(from.begin(), from.end(), before) - from.begin()));
  };
  const auto split = [&](Blocks& from, const auto& in) {  // takes the leading blocks that are `in`
    const Blocks rest = skip(from, in), front = from.first(from.size() - rest.size());
    from = rest;
    return front;
  };
  Blocks rows = skip(canonicalise, [&](const SampleBlock& b) { return b.area.y1 <= block.area.y0; });
  while (!rows.empty() && rows[0].area.y0 < block.area.y1) {
    Blocks row = split(rows, [y0 = rows[0].area.y0](const SampleBlock& b) { return b.area.y0 == y0; });
    row = skip(row, [&](const SampleBlock& b) { return b.area.x1 <= block.area.x0; });
    while (!row.empty() && row[0].area.x0 < block.area.x1) {
      Blocks column = split(row, [x0 = row[0].area.x0](const SampleBlock& b) { return b.area.x0 == x0; });
      column = skip(column, [&](const SampleBlock& b) { return b.samples.last <= block.samples.first; });
      for (std::size_t i = 0; i < column.size() && column[i].samples.first < block.samples.last; ++i) {
        if (!use(column[i])) return;
      }
    }
  }
}

}  // namespace

std::optional<SampleBlock> intersection(const SampleBlock& a, const SampleBlock& b) {
  const SampleBlock both{{std::max(a.area.x0, b.area.x0), std::max(a.area.y0, b.area.y0),
                          std::min(a.area.x1, b.area.x1), std::min(a.area.y1, b.area.y1)},
                         {std::max(a.samples.first, b.samples.first), std::min(a.samples.last, b.samples.last)}};
  const bool some =
      both.area.x0 < both.area.x1 && both.area.y0 < both.area.y1 && both.samples.first < both.samples.last;
  return some ? std::optional(both) : std::nullopt;
}

void Coverage::add(const Coverage& other) {
  blocks_.insert(blocks_.end(), other.blocks_.begin(), other.blocks_.end());
}

void Coverage::canonicalise() {
  struct Row {
    int y0, y1;
    std::vector<PixelColumn> columns;
  };
  std::vector<Row> rows;
  sweep(
      std::exchange(blocks_, {}), [](const SampleBlock& block) { return block.area.y0; },
      [](const SampleBlock& block) { return block.area.y1; },
      [&](int y0, int y1, const std::vector<SampleBlock>& blocks) {
        std::vector<PixelColumn> columns = columns_of(blocks);
        if (!rows.empty() && rows.back().y1 == y0 && rows.back().columns == columns) {
          rows.back().y1 = y1;
        } else {
          rows.push_back({y0, y1, std::move(columns)});
        }
      });
  for (const Row& row : rows) {
    for (const PixelColumn& column : row.columns) {
      for (const SampleRange range : column.ranges)
        blocks_.push_back({{column.x0, row.y0, column.x1, row.y1}, range});
    }
  }
}

bool Coverage::is_canonical() const {
  Blocks rest = blocks_, before;
  while (!rest.empty()) {
    const Blocks row = run_of(rest, &PixelRect::y0);
    if (!is_canonical_row(row)) return false;
    const auto same = [](const SampleBlock& a, const SampleBlock& b) {
      return a.area.x0 == b.area.x0 && a.area.x1 == b.area.x1 && a.samples == b.samples;
    };
    if (!before.empty() && before[0].area.y1 > row[0].area.y0) return false;
    const bool touch = !before.empty() && before[0].area.y1 == row[0].area.y0;
    if (touch && std::equal(before.begin(), before.end(), row.begin(), row.end(), same)) return false;
    before = row;
    rest = rest.subspan(row.size());
  }
  return true;
}

std::uint64_t Coverage::size() const {
  return std::accumulate(blocks_.begin(), blocks_.end(), std::uint64_t{0},
                         [](std::uint64_t sum, const SampleBlock& block) { return sum + block.size(); });
}

std::vector<SampleRange> Coverage::ranges() const {
  std::vector<SampleRange> all;
  for (const SampleBlock& block : blocks_) all.push_back(block.samples);
  return joined(std::move(all));
}

std::vector<SampleBlock> Coverage::missing(const SampleBlock& block) const {
  std::vector<SampleBlock> rest = {block}, pieces, settled;
  each_intersection(blocks_, block, [&](const SampleBlock& at) {
    pieces.clear();
    for (const SampleBlock& piece : rest) {
      if (is_behind(piece, at)) {
        settled.push_back(piece);
      } else if (const auto hole = intersection(piece, at)) {
        cut(piece, *hole, pieces);
      } else {
        pieces.push_back(piece);
      }
    }
    std::swap(rest, pieces);
    return !rest.empty();
  });
  settled.insert(settled.end(), rest.begin(), rest.end());
  return settled;
}

std::optional<SampleBlock> Coverage::overlap(const Coverage& other) const {
  std::optional<SampleBlock> both;
  for (const SampleBlock& block : other.blocks_) {
    each_intersection(blocks_, block, [&](const SampleBlock& at) {
      both = intersection(at, block);
      return false;
    });
    if (both) break;
  }
  return both;
}

}  // namespace fathom::runtime
