#include "runtime/field/slope_grid_builder.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <utility>

#include "vm/prune/specialise.h"

namespace fathom::runtime {
namespace {

// Maximum work: instructions bounded in all cells together, about half a second. In a long formula, of which every
// evaluation takes longer, as many as bound the formula in kCells cells: up to three seconds for a thousand nodes.
constexpr std::uint64_t kMaxWork = 3'000'000, kCells = 16'000;
// A cell is divided where a value lets a ray step by less than this share of the cell.
constexpr double kShortStep = 1;
// A pruned part replaces the whole if it has at most this share of its choices. Every part takes memory: with 0.9,
// the parts of a formula of 682 instructions took 100 MB.
constexpr double kWorthPruning = 0.5;

struct Cell {
  std::uint32_t x, y, z;
  compiler::Box box;
  std::shared_ptr<const vm::PrunedProgram> part;  // the part of the program that matters in an enclosing cell
  float slope = 0;
  bool divides = false;
};

class Builder {
 public:
  Builder(const vm::VerifiedProgram& program, const compiler::Box& box) {
    cells_.push_back({0, 0, 0, box, std::make_shared<const vm::PrunedProgram>(vm::whole(program))});
    max_work_ = std::max(kMaxWork, kCells * program.instructions());
  }

  std::vector<SlopeLevel> run(int levels) {
    std::vector<SlopeLevel> result = {make_level(1)};
    bound(cells_[0], result[0], 1);
    for (int level = 1; level < levels && work_ < max_work_; ++level) {
      SlopeLevel next = inherited(result.back(), 1u << level);
      std::vector<Cell> divided = std::exchange(cells_, {});
      // If the work ends within a level, the steepest cells have been divided.
      std::ranges::stable_sort(divided, std::greater(), &Cell::slope);
      for (Cell& cell : divided) {
        if (cell.divides && work_ < max_work_) divide(cell, next, 1u << level);
        cell.part.reset();
      }
      if (cells_.empty()) break;
      result.push_back(std::move(next));
    }
    return result;
  }

 private:
  static SlopeLevel make_level(std::size_t edge) {
    return {std::vector<float>(edge * edge * edge, std::numeric_limits<float>::infinity()),
            std::vector<float>(edge * edge * edge, 0), std::vector<std::uint8_t>(edge * edge * edge, 0)};
  }

  // Returns a level of twice as many cells along each axis, with the bounds of `coarse`.
  static SlopeLevel inherited(const SlopeLevel& coarse, std::size_t edge) {
    SlopeLevel level = make_level(edge);
    std::size_t at = 0;
    for (std::size_t z = 0; z < edge; ++z) {
      for (std::size_t y = 0; y < edge; ++y) {
        for (std::size_t x = 0; x < edge; ++x, ++at) {
          const std::size_t from = (z / 2 * (edge / 2) + y / 2) * (edge / 2) + x / 2;
          level.slopes[at] = coarse.slopes[from];
          level.errors[at] = coarse.errors[from];
          level.free[at] = coarse.free[from];
        }
      }
    }
    return level;
  }

  void divide(const Cell& cell, SlopeLevel& level, std::size_t edge) {
    const glm::dvec3 middle = (cell.box.lo + cell.box.hi) * 0.5;
    for (std::uint32_t i = 0; i < 8; ++i) {
      Cell child{2 * cell.x + (i & 1), 2 * cell.y + (i >> 1 & 1), 2 * cell.z + (i >> 2), cell.box, cell.part};
      for (int axis = 0; axis < 3; ++axis) {
        ((i >> axis & 1) != 0 ? child.box.lo : child.box.hi)[axis] = middle[axis];
      }
      bound(child, level, edge);
      if (child.divides) cells_.push_back(std::move(child));
    }
  }

  // Bounds the field in a cell and decides if the cell is to be divided.
  void bound(Cell& cell, SlopeLevel& level, std::size_t edge) {
    const vm::SlopeBound found = specialiser_.enclose_choices(*cell.part, cell.box.lo, cell.box.hi, workspace_);
    work_ += cell.part->sources.size();
    const std::size_t at = (cell.z * edge + cell.y) * edge + cell.x;
    const double slope = std::isfinite(found.float_error) ? found.lipschitz : std::numeric_limits<double>::infinity();
    level.slopes[at] = cell.slope = std::min(level.slopes[at], rounded_up(slope));
    const bool may_be_zero = found.value.lo <= 0 && found.value.hi >= 0;
    const bool known = std::isfinite(level.slopes[at]) && level.slopes[at] > 0;
    level.free[at] = !may_be_zero;
    level.errors[at] = may_be_zero && known ? static_cast<float>(found.float_error) / level.slopes[at] : 0;
    const glm::dvec3 size = cell.box.hi - cell.box.lo;
    const double least = may_be_zero ? 0 : std::min(std::abs(found.value.lo), std::abs(found.value.hi));
    cell.divides = known ? least < kShortStep * std::max({size.x, size.y, size.z}) * level.slopes[at] : may_be_zero;
    if (cell.divides) cut(cell);
  }

  static float rounded_up(double slope) {
    return std::nextafter(static_cast<float>(slope), std::numeric_limits<float>::infinity());
  }

  // Specialises the cell's part to the cell that bound() has just bounded.
  void cut(Cell& cell) {
    if (cell.part->choices == 0) return;
    specialiser_.resolve(-std::numeric_limits<float>::infinity(), std::numeric_limits<float>::infinity());
    if (specialiser_.choices_left(0) > kWorthPruning * cell.part->choices) return;
    auto smaller = std::make_shared<vm::PrunedProgram>();
    specialiser_.prune(0, *smaller);
    cell.part = std::move(smaller);
  }

  vm::Workspace workspace_;
  vm::Specialiser specialiser_;
  std::vector<Cell> cells_;  // of the last level, those that are to be divided
  std::uint64_t work_ = 0, max_work_;
};

}  // namespace

std::vector<SlopeLevel> build_slope_levels(const vm::VerifiedProgram& program, const compiler::Box& box, int levels) {
  return Builder(program, box).run(levels);
}

}  // namespace fathom::runtime
