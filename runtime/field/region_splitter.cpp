#include "runtime/field/region_splitter.h"

#include <cmath>
#include <limits>
#include <utility>

namespace fathom::runtime {
namespace {

// Cells down to this level are divided among the threads.
constexpr int kShared = 2;

}  // namespace

RegionSplitter::RegionSplitter(const SplitRules& rules, RegionBudget& budget)
    : rules_(rules),
      budget_(budget),
      levels_(rules.tree.levels),
      leaf_choices_(rules.choice_factor * kLeafChoices),
      parts_(static_cast<std::size_t>(levels_) + 1) {}

void RegionSplitter::run(const RegionCell& cell, RegionPiece& piece) {
  piece_ = &piece;
  piece.nodes.resize(8);
  split(cell.part, cell.at, cell.level, cell.limit, cell.unshortened, 0);
}

void RegionSplitter::split(const vm::PrunedProgram& part, const CellIndex& at, int level, float limit,
                           int unshortened_levels, std::uint32_t first) {
  budget_.work += part.sources.size();
  if (budget_.is_spent()) return;
  if (rules_.options.interrupted && rules_.options.interrupted()) {
    budget_.interrupted = true;
    return;
  }
  const int below = level + 1;
  const std::size_t bytes_before = bytes_of(*piece_);
  const BoxArrays boxes = children_of(at, below);
  specialiser_.enclose_choices(part, boxes.view(), workspace_);
  const Limits limits = limits_of(boxes, limit);
  Children done = make_far(limits, first);
  Parts& parts = parts_[static_cast<std::size_t>(below)];
  make_parts(limits, below, first, done, parts);
  budget_.bytes += bytes_of(*piece_) - bytes_before + 8 * sizeof(Node);
  for (std::uint32_t i = 0; i < 8; ++i) {
    if (done[i]) continue;
    const double shorter = static_cast<double>(parts[i].words.size()) / static_cast<double>(part.words.size());
    const CellIndex cell = {2 * at[0] + (i & 1), 2 * at[1] + (i >> 1 & 1), 2 * at[2] + (i >> 2)};
    place_child(parts[i], shorter, cell, below, limits[i], unshortened_levels, first + i);
  }
}

void RegionSplitter::place_child(vm::PrunedProgram& child, double shorter, const CellIndex& at, int level,
                                 float limit, int unshortened_levels, std::uint32_t node) {
  const int unshortened = shorter < kShorterPart || level <= rules_.options.room ? 0 : unshortened_levels + 1;
  if (unshortened > kMaxIdle) return make_leaf(child, limit, node);
  if (level <= kShared) {
    budget_.pending_bytes += child.bytes();
    piece_->pending.push_back({at, level, limit, unshortened, std::move(child), node});
    return;
  }
  const auto grandchildren = static_cast<std::uint32_t>(piece_->nodes.size());
  piece_->nodes.resize(grandchildren + 8);
  piece_->nodes[node] = make_node(Kind::Inner, grandchildren, 0);
  split(child, at, level, limit, unshortened, grandchildren);
}

RegionSplitter::Limits RegionSplitter::limits_of(const BoxArrays& boxes, float limit) const {
  Limits limits;
  for (std::size_t i = 0; i < limits.size(); ++i) limits[i] = limit_of(boxes, i, limit);
  return limits;
}

float RegionSplitter::limit_of(const BoxArrays& boxes, std::size_t i, float limit) const {
  const float most = std::min(limit, rules_.far.cap({boxes.lo[0][i], boxes.lo[1][i], boxes.lo[2][i]},
                                                    {boxes.hi[0][i], boxes.hi[1][i], boxes.hi[2][i]}));
  const float hi = specialiser_.hi(i), highest = std::min(hi + error_ + kCellError * std::abs(hi), most);
  return std::max(rules_.far.first, rules_.far.level(highest));
}

RegionSplitter::CellFacts RegionSplitter::bound_cells(const vm::PrunedProgram& part,
                                                      const std::array<glm::dvec3, vm::kEnclosedBoxes>& points,
                                                      int level) {
  std::array<CellIndex, vm::kEnclosedBoxes> cells;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      cells[i][static_cast<std::size_t>(axis)] = static_cast<std::uint32_t>(points[i][axis] * (1u << level));
    }
  }
  const BoxArrays boxes = boxes_of(cells, level);
  specialiser_.enclose_choices(part, boxes.view(), workspace_);
  CellFacts facts{};
  std::array<bool, vm::kEnclosedBoxes> seen{};
  for (std::size_t begin = 0; begin < cells.size(); ++begin) {
    if (seen[begin]) continue;
    const float limit = limit_of(boxes, begin, std::numeric_limits<float>::infinity());
    specialiser_.resolve(-std::numeric_limits<float>::infinity(), limit, error_);
    for (std::size_t i = begin; i < cells.size(); ++i) {
      if (seen[i] || limit_of(boxes, i, std::numeric_limits<float>::infinity()) != limit) continue;
      seen[i] = true;
      facts.far[i] = is_far(i, limit);
      facts.choices[i] = specialiser_.choices_left(i);
    }
  }
  return facts;
}

RegionSplitter::Children RegionSplitter::make_far(const Limits& limits, std::uint32_t first) {
  Children far;
  for (std::uint32_t i = 0; i < far.size(); ++i) {
    far[i] = is_far(i, limits[i]);
    if (!far[i]) continue;
    piece_->nodes[first + i] = make_node(Kind::Far, 0, limits[i]);
    ++piece_->summary.far;
  }
  return far;
}

void RegionSplitter::make_parts(const Limits& limits, int level, std::uint32_t first, Children& done, Parts& parts) {
  Children seen = done;
  for (std::size_t begin = 0; begin < seen.size(); ++begin) {
    if (seen[begin]) continue;
    specialiser_.resolve(-std::numeric_limits<float>::infinity(), limits[begin], error_);
    for (std::size_t i = begin; i < seen.size(); ++i) {
      if (seen[i] || limits[i] != limits[begin]) continue;
      seen[i] = true;
      specialiser_.prune(i, parts[i]);
      done[i] = specialiser_.choices_left(i) <= leaf_choices_ || level >= levels_;
      if (done[i]) make_leaf(parts[i], limits[i], first + static_cast<std::uint32_t>(i));
    }
  }
}

BoxArrays RegionSplitter::children_of(const CellIndex& at, int level) {
  std::array<CellIndex, vm::kEnclosedBoxes> cells;
  for (std::uint32_t i = 0; i < cells.size(); ++i) {
    cells[i] = {2 * at[0] + (i & 1), 2 * at[1] + (i >> 1 & 1), 2 * at[2] + (i >> 2 & 1)};
  }
  return boxes_of(cells, level);
}

BoxArrays RegionSplitter::boxes_of(const std::array<CellIndex, vm::kEnclosedBoxes>& cells, int level) {
  BoxArrays boxes;
  const double size = static_cast<double>(rules_.tree.size), edge = size / (1u << level), margin = size * kCellMargin;
  float largest = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < vm::kEnclosedBoxes; ++i) {
      const double lo = static_cast<double>(rules_.tree.lo[axis]) + edge * cells[i][axis];
      boxes.lo[axis][i] = static_cast<float>(lo - margin), boxes.hi[axis][i] = static_cast<float>(lo + edge + margin);
      largest = std::max({largest, -boxes.lo[axis][i], boxes.hi[axis][i]});
    }
  }
  error_ = kCellError * (largest + rules_.options.cancellation);
  return boxes;
}

std::size_t RegionSplitter::bytes_of(const RegionPiece& piece) {
  return (piece.pool.size() + piece.programs.size() + piece.slots.size()) * sizeof(std::uint32_t) +
         piece.program_templates.bytes();
}

void RegionSplitter::make_leaf(const vm::PrunedProgram& part, float limit, std::uint32_t node) {
  const std::uint32_t at = piece_->program_templates.pack(part, rules_.constants, piece_->pool);
  piece_->nodes[node] = make_node(Kind::Program, intern(at), limit);
  ++piece_->summary.programs;
}

std::uint32_t RegionSplitter::intern(std::uint32_t start) {
  RegionPiece& piece = *piece_;
  piece.programs.push_back(start);
  if (2 * piece.programs.size() > piece.slots.size()) grow_slots();
  std::uint32_t& slot = piece.slots[slot_of(program(piece.programs.size() - 1))];
  if (slot == 0) {
    slot = static_cast<std::uint32_t>(piece.programs.size());
    return start;
  }
  piece.programs.pop_back();
  piece.pool.resize(start);
  return piece.programs[slot - 1];
}

std::span<const std::uint32_t> RegionSplitter::program(std::size_t number) const {
  const RegionPiece& piece = *piece_;
  const std::size_t begin = piece.programs[number];
  const bool last = number + 1 == piece.programs.size();
  return std::span(piece.pool).subspan(begin, (last ? piece.pool.size() : piece.programs[number + 1]) - begin);
}

// Returns the slot of an equal program, or the free slot for the wanted program.
std::size_t RegionSplitter::slot_of(std::span<const std::uint32_t> wanted) const {
  const std::vector<std::uint32_t>& slots = piece_->slots;
  for (std::size_t at = vm::hash_of(wanted);; ++at) {
    const std::uint32_t held = slots[at & (slots.size() - 1)];
    if (held == 0 || std::ranges::equal(program(held - 1), wanted)) return at & (slots.size() - 1);
  }
}

// Enters all programs except the last, which has no slot yet, into a larger table.
void RegionSplitter::grow_slots() {
  RegionPiece& piece = *piece_;
  piece.slots.assign(std::max<std::size_t>(64, 2 * piece.slots.size()), 0);
  for (std::uint32_t i = 0; i + 1 < piece.programs.size(); ++i) piece.slots[slot_of(program(i))] = i + 1;
}

}  // namespace fathom::runtime
