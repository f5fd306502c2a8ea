#include "runtime/region_splitter.h"

#include <cmath>
#include <limits>

#include "runtime/field.h"

namespace fathom::runtime {
namespace {

// A leaf's limit in half diagonals: how far a step from within it goes at most, but where a longer one costs nothing.
constexpr float kLimit = 0.6f;
// The same of what is split further.
constexpr float kInnerLimit = 0.7f;
// Choices in a program short enough for a leaf.
constexpr std::uint32_t kLeafChoices = 3;
// Cells are split no further after so many levels at which their parts did not get this much shorter.
constexpr double kShorterPart = 0.9;
constexpr int kMostIdle = 2;
// Cells down to this level are shared out among the threads.
constexpr int kShared = 2;

}  // namespace

RegionBuilder::Splitter::Splitter(RegionBuilder& builder)
    : builder_(builder),
      regions_(*builder.regions_),
      levels_(regions_.tree_.levels),
      leaf_choices_(builder.longer_ * kLeafChoices),
      parts_(static_cast<std::size_t>(levels_) + 1) {}

void RegionBuilder::Splitter::run(const Cell& cell, Piece& piece) {
  piece_ = &piece;
  piece.nodes.resize(8);
  split(cell.part, cell.at, cell.level, cell.limit, cell.idle, 0);
}

void RegionBuilder::Splitter::split(const vm::Part& part, const Place& at, int level, float limit, int idle_so_far,
                                    std::uint32_t first) {
  if (builder_.bytes_ > builder_.options_.memory || builder_.work_ > kMostWork) return;  // in vain
  builder_.work_ += part.sources.size();
  const int below = level + 1;
  const std::size_t bytes_before = bytes_of(*piece_);
  const float edge = regions_.tree_.size / static_cast<float>(1u << below), half_diagonal = edge * 0.8661f;
  const BoxArrays boxes = children_of(at, below);
  specialiser_.look(part, boxes.view(), workspace_);
  Children children{};
  Parts& parts = parts_[static_cast<std::size_t>(below)];
  find_far(part, boxes, half_diagonal, below, limit, first, children);
  const float scale = half_diagonal * regions_.tree_.lipschitz;
  make_leaves(limit, below, first, children, parts);
  make_leaves(std::min(limit, kLimit * scale), below, first, children, parts);
  const float inner = std::min(limit, kInnerLimit * scale);
  cut(inner, children, parts);
  builder_.bytes_ += bytes_of(*piece_) - bytes_before + 8 * sizeof(Node);
  for (std::uint32_t i = 0; i < 8; ++i) {
    if (children[i]) continue;
    const bool shorter = parts[i].words.size() < kShorterPart * static_cast<double>(part.words.size());
    const int idle = shorter || below <= builder_.options_.room ? 0 : idle_so_far + 1;
    if (idle > kMostIdle) {
      make_leaf(parts[i], true, 0, below, inner, first + i);
      continue;
    }
    const Place cell = {2 * at[0] + (i & 1), 2 * at[1] + (i >> 1 & 1), 2 * at[2] + (i >> 2)};
    if (below <= kShared) {
      piece_->pending.push_back({cell, below, inner, idle, parts[i], first + i});
      continue;
    }
    const auto grandchildren = static_cast<std::uint32_t>(piece_->nodes.size());
    piece_->nodes.resize(grandchildren + 8);
    piece_->nodes[first + i] = make_node(Kind::Inner, grandchildren, 0);
    split(parts[i], cell, below, inner, idle, grandchildren);
  }
}

void RegionBuilder::Splitter::cut(float limit, const Children& done, Parts& parts) {
  if (std::all_of(done.begin(), done.end(), [](bool d) { return d; })) return;
  specialiser_.decide(-std::numeric_limits<float>::infinity(), limit);
  for (std::size_t i = 0; i < 8; ++i) {
    if (!done[i]) specialiser_.part(i, parts[i]);
  }
}

void RegionBuilder::Splitter::make_leaves(float limit, int level, std::uint32_t first, Children& done, Parts& parts) {
  if (std::all_of(done.begin(), done.end(), [](bool d) { return d; })) return;
  specialiser_.decide(-std::numeric_limits<float>::infinity(), limit);
  for (std::size_t i = 0; i < 8; ++i) {
    const std::uint32_t left = done[i] ? 0 : specialiser_.choices_left(i);
    if (done[i] || (left > leaf_choices_ && level < levels_)) continue;
    specialiser_.part(i, parts[i]);
    done[i] = make_leaf(parts[i], false, left, level, limit, first + static_cast<std::uint32_t>(i));
  }
}

BoxArrays RegionBuilder::Splitter::children_of(const Place& at, int level) const {
  BoxArrays boxes;
  const double size = static_cast<double>(regions_.tree_.size), edge = size / (1u << level),
               margin = size * kCellMargin;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < vm::kEnclosedBoxes; ++i) {
      const double lo = static_cast<double>(regions_.tree_.lo[axis]) + edge * (2.0 * at[axis] + (i >> axis & 1));
      boxes.lo[axis][i] = static_cast<float>(lo - margin), boxes.hi[axis][i] = static_cast<float>(lo + edge + margin);
    }
  }
  return boxes;
}

std::size_t RegionBuilder::Splitter::bytes_of(const Piece& piece) {
  return piece.pool.size() * sizeof(std::uint32_t) + piece.skeletons.bytes();
}

void RegionBuilder::Splitter::find_far(const vm::Part& part, const BoxArrays& boxes, float half_diagonal, int level,
                                       float limit, std::uint32_t first, Children& children) {
  const float enough = kFar * half_diagonal * regions_.tree_.lipschitz;
  std::array<float, 8> x, y, z, centre;
  bool any = false;
  for (std::size_t i = 0; i < 8; ++i) {
    children[i] = specialiser_.lo(i) > enough;
    any = any || children[i];
    const auto middle = [&](std::size_t axis) { return (boxes.lo[axis][i] + boxes.hi[axis][i]) / 2; };
    x[i] = middle(0), y[i] = middle(1), z[i] = middle(2);
  }
  if (!any) return;
  vm::evaluate_distance(part, {x.data(), y.data(), z.data()}, 8, centre.data(), workspace_);
  for (std::uint32_t i = 0; i < 8; ++i) {
    if (!children[i]) continue;
    // Above the limit the part says no more than that. The rest is for rounding.
    const float error =
        4 * kDistanceError * std::max({1.0f, std::abs(x[i]), std::abs(y[i]), std::abs(z[i]), centre[i]});
    const float value = std::min(centre[i], limit) - error - 1e-5f * half_diagonal * regions_.tree_.lipschitz;
    piece_->nodes[first + i] = make_node(Kind::Far, static_cast<std::uint32_t>(level), value);
    ++piece_->facts.far;
  }
}

bool RegionBuilder::Splitter::make_leaf(vm::Part& part, bool always, std::uint32_t choices, int level, float limit,
                                        std::uint32_t node) {
  if (choices > leaf_choices_ && !always && level < levels_) return false;
  const std::uint32_t at = piece_->skeletons.pack(part, *regions_.constants_, piece_->pool);
  piece_->nodes[node] = make_node(Kind::Program, intern(at), limit);
  ++piece_->facts.programs;
  return true;
}

std::uint32_t RegionBuilder::Splitter::intern(std::uint32_t start) {
  std::vector<std::uint32_t>& pool = piece_->pool;
  const std::size_t size = pool.size() - start;
  const std::uint64_t hash = vm::hash_of(std::span(pool).subspan(start));
  const auto [first, last] = piece_->program_at.equal_range(hash);
  for (auto it = first; it != last; ++it) {
    if (it->second + size <= start && std::equal(pool.begin() + start, pool.end(), pool.begin() + it->second)) {
      pool.resize(start);
      return it->second;
    }
  }
  piece_->program_at.emplace(hash, start);
  piece_->programs.push_back(start);
  return start;
}

}  // namespace fathom::runtime
