#include "runtime/sampling/piecewise_constant_sphere.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>
#include <numeric>

#include "hwy/cache_control.h"
#include "runtime/sampling/piecewise_constant_sphere_lanes.h"
#include "vm/number/real.h"
#include "vm/program/check.h"

namespace fathom::runtime {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

RunningSums sums_of(std::size_t rows, std::size_t size, std::size_t bins) {
  RunningSums out{.size = size, .bins = bins, .sums = {}, .guide = {}};
  out.sums.reserve(rows * (size + 1));
  out.guide.reserve(rows * (bins + 1));
  return out;
}

// Adds a row of cells with these weights, whose sum is `total`. Replaces the weights by the shares that the rounded
// sums give.
void add_row(std::span<double> weights, double total, RunningSums& out) {
  const std::size_t begin = out.sums.size();
  double running = 0;
  out.sums.push_back(0);
  for (double& weight : weights) {
    running += weight;
    out.sums.push_back(total > 0 ? static_cast<float>(running / total) : 1.0f);
    weight = static_cast<double>(out.sums.back()) - static_cast<double>(out.sums[out.sums.size() - 2]);
  }
  const float* sums = &out.sums[begin];
  std::uint32_t cell = 0;
  for (std::size_t bin = 0; bin <= out.bins; ++bin) {
    // No number in [0,1) lies at the end of the last bin.
    const float u = std::min(static_cast<float>(bin) / static_cast<float>(out.bins), 0x1.fffffep-1f);
    while (cell + 1 < out.size && sums[cell + 1] <= u) ++cell;
    out.guide.push_back(cell);
  }
}

// Returns the guide's entry for u in [0,1) in a row.
const std::uint32_t* guide_at(const RunningSums& in, std::size_t row, float u) {
  return &in.guide[row * (in.bins + 1) + static_cast<std::size_t>(u * static_cast<float>(in.bins))];
}
const float* sums_at(const RunningSums& in, std::size_t row) { return &in.sums[row * (in.size + 1)]; }

struct FoundCell {
  std::size_t cell;
  float share;  // how far u lies into the cell, in [0,1]
};

FoundCell find(const float* sums, const std::uint32_t* guide, float u) {
  std::size_t low = guide[0], high = guide[1];
  while (low < high) {
    const std::size_t middle = (low + high + 1) / 2;
    const bool above = u < sums[middle];
    low = above ? low : middle;
    high = above ? middle - 1 : high;
  }
  return {low, std::clamp((u - sums[low]) / (sums[low + 1] - sums[low]), 0.0f, 1.0f)};
}

// Returns 1 - |cos| of the angle, where `from_above` is true from the pole at 0, else from that at pi.
double pole_distance(double angle, bool from_above) {
  const double sine = vm::real::sin((from_above ? angle : std::numbers::pi - angle) / 2);
  return 2 * sine * sine;
}

}  // namespace

glm::dvec3 from_latlong(glm::dvec2 uv) {
  const double polar = uv.y * std::numbers::pi, turn = uv.x * kTurn;
  const double sine = vm::real::sin(polar);
  return {-sine * vm::real::sin(turn), vm::real::cos(polar), sine * vm::real::cos(turn)};
}

double mean_over_sphere(int width, int height, std::span<const float> values) {
  const std::size_t columns = static_cast<std::size_t>(width);
  double sum = 0, above = 1;  // the height of the row's upper end
  for (int row = 0; row < height; ++row) {
    const std::span<const float> of_row = values.subspan(static_cast<std::size_t>(row) * columns, columns);
    const double below = vm::real::cos(std::numbers::pi * (row + 1) / height);
    sum += (above - below) / 2 * std::accumulate(of_row.begin(), of_row.end(), 0.0) / width;
    above = below;
  }
  return sum;
}

PiecewiseConstantSphere::PiecewiseConstantSphere(int width, int height, std::span<const float> values,
                                                 std::span<const glm::vec3> pixels) {
  const std::size_t cells = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  CHECK(width > 0 && height > 0 && values.size() == cells && (pixels.empty() || pixels.size() == cells),
        "a table of directions has width x height cells");
  tables_.width = width;
  tables_.height = height;
  for (int row = 0; row < height; ++row) {
    const bool above = row < rows_above(height);
    const double begin = pole_distance(std::numbers::pi * row / height, above);
    const double end = pole_distance(std::numbers::pi * (row + 1) / height, above);
    tables_.pole_distance.push_back(static_cast<float>(begin));
    tables_.pole_step.push_back(static_cast<float>(end - begin));
  }
  tables_.cells.resize((static_cast<std::size_t>(width) + 2) * (static_cast<std::size_t>(height) + 2));
  set_densities(values);
  if (!pixels.empty()) set_pixels(pixels);
  set_border();
}

SphereCell& PiecewiseConstantSphere::cell_at(int row, int column) {
  const std::size_t line = static_cast<std::size_t>(tables_.width) + 2;
  return tables_.cells[static_cast<std::size_t>(row + 1) * line + static_cast<std::size_t>(column + 1)];
}

void PiecewiseConstantSphere::set_densities(std::span<const float> values) {
  const int width = tables_.width, height = tables_.height;
  const std::size_t columns = static_cast<std::size_t>(width);
  const auto solid_angle = [&](int row) {  // of one cell
    return kTurn / width * std::abs(static_cast<double>(tables_.pole_step[static_cast<std::size_t>(row)]));
  };
  std::vector<double> totals, rows, weights(columns);
  double sum = 0;
  for (int row = 0; row < height; ++row) {
    const std::span<const float> of_row = values.subspan(static_cast<std::size_t>(row) * columns, columns);
    totals.push_back(std::accumulate(of_row.begin(), of_row.end(), 0.0));
    rows.push_back(totals.back() * solid_angle(row));
    sum += rows.back();
  }
  mean_ = sum / (2 * kTurn);
  if (!(mean_ > 0)) return;
  // The rows' guide leaves few searches. One of a quarter of the columns' cells leaves two steps, in little memory.
  const auto power = [](std::size_t cells) { return std::bit_ceil(cells); };
  tables_.rows = sums_of(1, rows.size(), 4 * power(rows.size()));
  tables_.columns = sums_of(rows.size(), columns, std::max<std::size_t>(power(columns) / 4, 1));
  add_row(rows, sum, tables_.rows);
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const std::span<const float> of_row = values.subspan(row * columns, columns);
    std::copy(of_row.begin(), of_row.end(), weights.begin());
    add_row(weights, totals[row], tables_.columns);
    const double scale = rows[row] / solid_angle(static_cast<int>(row));
    for (std::size_t i = 0; i < columns; ++i) {
      cell_at(static_cast<int>(row), static_cast<int>(i)).light[3] = static_cast<float>(weights[i] * scale);
    }
  }
}

void PiecewiseConstantSphere::set_pixels(std::span<const glm::vec3> pixels) {
  auto pixel = pixels.begin();
  for (int row = 0; row < tables_.height; ++row) {
    for (int column = 0; column < tables_.width; ++column, ++pixel) {
      for (int channel = 0; channel < 3; ++channel) {
        cell_at(row, column).light[channel] = (*pixel)[channel];
      }
    }
  }
}

void PiecewiseConstantSphere::set_border() {
  const int width = tables_.width, height = tables_.height;
  for (int row = 0; row < height; ++row) {
    cell_at(row, -1) = cell_at(row, width - 1);
    cell_at(row, width) = cell_at(row, 0);
  }
  for (int column = -1; column <= width; ++column) {
    cell_at(-1, column) = cell_at(0, column);
    cell_at(height, column) = cell_at(height - 1, column);
  }
}

// Hardly anything of a large image is in the cache. All that the rays need is therefore asked for first.
void PiecewiseConstantSphere::sample(std::size_t count, const float* u, const float* v, float turn,
                                     DirectionRows& rows) const {
  const auto width = static_cast<float>(tables_.width);
  const auto columns = static_cast<std::size_t>(tables_.width);
  const auto above = static_cast<std::size_t>(rows_above(tables_.height));
  std::array<FoundCell, DirectionRows::kCapacity> row;
  std::array<const std::uint32_t*, DirectionRows::kCapacity> guide;
  std::array<std::int32_t, DirectionRows::kCapacity> own;
  for (std::size_t i = 0; i < count; ++i) {
    row[i] = find(tables_.rows.sums.data(), guide_at(tables_.rows, 0, v[i]), v[i]);
    guide[i] = guide_at(tables_.columns, row[i].cell, u[i]);
    hwy::Prefetch(guide[i]);
  }
  for (std::size_t i = 0; i < count; ++i) hwy::Prefetch(sums_at(tables_.columns, row[i].cell) + guide[i][0]);
  PolarRows polar;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t cell = row[i].cell;
    const FoundCell column = find(sums_at(tables_.columns, cell), guide[i], u[i]);
    polar.turns[i] = (static_cast<float>(column.cell) + column.share) / width + turn;
    polar.distance[i] = tables_.pole_distance[cell] + row[i].share * tables_.pole_step[cell];
    polar.pole[i] = cell < above ? 1.0f : -1.0f;
    own[i] = static_cast<std::int32_t>((cell + 1) * (columns + 2) + column.cell + 1);
  }
  set_directions(count, polar, rows);
  SphereCellRows places;
  find_cells(tables_, turn, count, rows, places);
  std::copy_n(own.begin(), count, places.own);
  interpolate(count, places, rows);
}

void PiecewiseConstantSphere::look_up(std::size_t count, float turn, DirectionRows& rows) const {
  SphereCellRows places;
  find_cells(tables_, turn, count, rows, places);
  interpolate(count, places, rows);
}

void PiecewiseConstantSphere::interpolate(std::size_t count, const SphereCellRows& places,
                                          DirectionRows& rows) const {
  const SphereCell* cells = tables_.cells.data();
  for (std::size_t i = 0; i < count; ++i) {
    hwy::Prefetch(cells + places.cell[i]);
    hwy::Prefetch(cells + places.cell[i] + tables_.width + 2);
  }
  interpolate_cells(tables_, count, places, rows);
}

}  // namespace fathom::runtime
