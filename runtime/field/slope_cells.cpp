// Compiled once for each instruction set and chosen at run time (Highway's foreach_target).
#include "runtime/field/slope_cells.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "runtime/field/slope_grid_builder.h"
#include "vm/program/opcode.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "runtime/field/slope_cells.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "vm/number/batch-inl.h"

#ifndef FATHOM_SLOPE_CELLS_CONSTANTS
#define FATHOM_SLOPE_CELLS_CONSTANTS
namespace fathom::runtime {

// Shares of a radius and of the way to a block's end that count: more than rounding takes.
inline constexpr float kTrustedRadius = 1 - 0x1p-18f, kTrustedWay = 1 - 0x1p-12f;
// Radius where there is no bound: keeps the sign of the value.
inline constexpr float kNoRadius = 0x1p-126f;
// Replaces an infinite value or way, for use in products with 0.
inline constexpr float kFarAway = 1e30f;

}  // namespace fathom::runtime
#endif

HWY_BEFORE_NAMESPACE();
namespace fathom::runtime::HWY_NAMESPACE {

using namespace vm::HWY_NAMESPACE;
using CellInts = hn::RebindToSigned<FloatLanes>;

HWY_INLINE Batch constant_of(float value) { return Batch::broadcast(value); }

// Returns the radii that one level tells at points of the grid.
class LevelRadius {
 public:
  HWY_INLINE LevelRadius(const SlopeGrid& grid, int level) : grid_(grid), level_(level) {}

  HWY_INLINE Batch operator()(const Batch (&point)[3], Batch size) const {
    const CellInts ints;
    const float edge = static_cast<float>(1 << level_);
    auto index = hn::Zero(ints);
    Batch way = constant_of(kFarAway);
    for (int axis = 2; axis >= 0; --axis) {
      const auto a = static_cast<std::size_t>(axis);
      const Batch place = (point[axis] - constant_of(grid_.lo[a])) * constant_of(edge / grid_.extent[a]);
      const Batch cell = min(max(floor(place), constant_of(0)), constant_of(edge - 1));
      index = hn::Add(hn::ShiftLeftSame(index, level_), hn::ConvertTo(ints, cell.v));
      // The block's ends on the grid's own end are no ends.
      const Batch below = select(cell > constant_of(0), place - cell + constant_of(1), constant_of(kFarAway));
      const Batch above = select(cell < constant_of(edge - 1), cell + constant_of(2) - place, constant_of(kFarAway));
      way = min(way, min(below, above) * constant_of(grid_.extent[a] / edge));
    }
    const Batch inverse{
        hn::GatherIndex(FloatLanes(), grid_.inverse_slopes[static_cast<std::size_t>(level_)].data(), index)};
    return min(size * inverse, way * constant_of(kTrustedWay));
  }

 private:
  const SlopeGrid& grid_;
  const int level_;
};

void to_radii_lanes(const SlopeGrid& grid, const vm::Points& points, std::size_t count, float* values) {
  for (std::size_t i = 0; i < count; i += kLanes) {
    const Batch point[3] = {Batch::load(points.x + i), Batch::load(points.y + i), Batch::load(points.z + i)};
    const Batch value = Batch::load(values + i), size = min(abs(value), constant_of(kFarAway));
    Batch outside = constant_of(-kFarAway), to_formulas = constant_of(0);
    for (std::size_t a = 0; a < 3; ++a) {
      outside = max(outside, max(constant_of(grid.lo[a]) - point[a], point[a] - constant_of(grid.hi[a])));
      to_formulas = max(to_formulas,
                        max(constant_of(grid.formula_lo[a]) - point[a], point[a] - constant_of(grid.formula_hi[a])));
    }
    const auto in_grid = outside <= constant_of(0);
    Batch radius = min(size * constant_of(grid.inverse_rest), to_formulas);
    if (any(in_grid)) {
      Batch best = constant_of(0);
      for (int level = 0; level < grid.levels; ++level) best = max(best, LevelRadius(grid, level)(point, size));
      radius = select(in_grid, best, radius);
    }
    radius = max(radius * constant_of(kTrustedRadius), min(size, constant_of(kNoRadius)));
    const Batch found{hn::CopySign(radius.v, value.v)};
    select(is_nan(value), value, found).store(values + i);
  }
}

}  // namespace fathom::runtime::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace fathom::runtime {
namespace {

HWY_EXPORT(to_radii_lanes);

// Width of the grid's rim around the formulas, as a share of their box: rays outside the grid come no nearer to the
// box than the rim is wide, and must not need ever shorter steps there.
constexpr double kRim = 1.0 / 24;

std::array<float, 3> to_floats(glm::dvec3 v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

// Returns, per cell, the maximum over the cell and its neighbours, of which those beyond the grid have the value
// `rest`.
template <class T>
std::vector<T> block_maxima(std::vector<T> values, std::size_t edge, T rest) {
  if (edge == 1) return {std::max(values[0], rest)};
  std::vector<T> out(values.size());
  for (std::size_t stride = 1; stride < values.size(); stride *= edge) {
    for (std::size_t at = 0; at < values.size(); ++at) {
      const std::size_t i = at / stride % edge;
      out[at] = std::max({values[at], i > 0 ? values[at - stride] : rest, i + 1 < edge ? values[at + stride] : rest});
    }
    values.swap(out);
  }
  return values;
}

// Returns 1 / maximum slope over every cell and its neighbours.
std::vector<float> inverse_block_slopes(SlopeLevel level, std::size_t edge, float rest) {
  for (std::uint8_t& holds_zero : level.free) holds_zero = !holds_zero;
  // Beyond the grid the rest of the field may have zeros.
  const std::vector<std::uint8_t> zeros = block_maxima<std::uint8_t>(std::move(level.free), edge, rest > 0);
  std::vector<float> slopes = block_maxima(std::move(level.slopes), edge, rest);
  for (std::size_t i = 0; i < slopes.size(); ++i) {
    slopes[i] = zeros[i] ? 1 / std::max(slopes[i], 1 / kFarAway) : kFarAway;
  }
  return slopes;
}

// Returns a cancellation that covers the float errors of most cells, given those of all cells that may hold a zero.
// In a grid of length `extent`, it is limited: a field that is level in most cells has errors of any size there.
float typical_cancellation(std::vector<float> errors, float extent) {
  constexpr float kMost = 32;
  std::erase(errors, 0.0f);
  if (errors.empty()) return 0;
  const auto middle = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2);
  std::nth_element(errors.begin(), middle, errors.end());
  return std::min(2 * *middle / static_cast<float>(vm::kFloatError), kMost * std::max(1.0f, extent));
}

}  // namespace

SlopeCells::SlopeCells(const vm::VerifiedProgram& program, const compiler::Box& formulas, double rest_lipschitz) {
  const glm::dvec3 rim = (formulas.hi - formulas.lo) * kRim;
  grid_.lo = to_floats(formulas.lo - rim);
  grid_.hi = to_floats(formulas.hi + rim);
  const compiler::Box box{{grid_.lo[0], grid_.lo[1], grid_.lo[2]}, {grid_.hi[0], grid_.hi[1], grid_.hi[2]}};
  grid_.formula_lo = to_floats(formulas.lo);
  grid_.formula_hi = to_floats(formulas.hi);
  for (std::size_t a = 0; a < 3; ++a) grid_.extent[a] = grid_.hi[a] - grid_.lo[a];
  std::vector<SlopeLevel> levels = build_slope_levels(program, box, SlopeGrid::kLevels);
  cancellation_ =
      typical_cancellation(levels.back().errors, std::max({grid_.extent[0], grid_.extent[1], grid_.extent[2]}));
  const float rest = static_cast<float>(rest_lipschitz);
  grid_.inverse_rest = rest > 0 ? 1 / rest : kFarAway;
  grid_.levels = static_cast<int>(levels.size());
  const float most = static_cast<float>(vm::kFloatError) * (1 + cancellation_);
  for (std::size_t level = 0; level < levels.size(); ++level) {
    std::vector<float>& slopes = levels[level].slopes;
    // A slope so small that the radius would have a larger error counts as greater.
    for (std::size_t i = 0; i < slopes.size(); ++i) {
      if (levels[level].errors[i] > most) slopes[i] *= levels[level].errors[i] / most;
    }
    grid_.inverse_slopes[level] = inverse_block_slopes(std::move(levels[level]), std::size_t{1} << level, rest);
  }
  constexpr double kStretch = 4;
  const glm::dvec3 cell = (box.hi - box.lo) / static_cast<double>(1 << (grid_.levels - 1));
  stretch_ = kStretch * std::min({cell.x, cell.y, cell.z});
}

void SlopeCells::to_radii(vm::Points points, std::size_t count, float* values) const {
  HWY_DYNAMIC_DISPATCH(to_radii_lanes)(grid_, points, count, values);
}

void SlopeCells::inverse_slopes(vm::Points points, std::size_t count, float* out) const {
  constexpr float kValue = 0x1p-40f;  // so small that the slope alone decides the radius
  std::fill_n(out, count, kValue);
  to_radii(points, count, out);
  for (std::size_t i = 0; i < count; ++i) out[i] = out[i] > kNoRadius ? out[i] / kValue : 0;
}

// In float: a radius has no more digits than its slope.
double SlopeCells::radius(double value, glm::dvec3 point) const {
  alignas(64) float x[16] = {static_cast<float>(point.x)}, y[16] = {static_cast<float>(point.y)},
                    z[16] = {static_cast<float>(point.z)}, radius[16] = {static_cast<float>(value)};
  to_radii({x, y, z}, 1, radius);
  return static_cast<double>(radius[0]);
}

std::size_t SlopeCells::bytes() const {
  std::size_t sum = 0;
  for (const std::vector<float>& level : grid_.inverse_slopes) sum += level.size() * sizeof(float);
  return sum;
}

}  // namespace fathom::runtime
#endif  // HWY_ONCE
