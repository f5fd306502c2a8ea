#include "runtime/sampling/piecewise_constant_sphere.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "runtime/base/elementary.h"
#include "vm/number/real.h"
#include "vm/program/check.h"

namespace fathom::runtime {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

// Finds u among running sums that end at 1. Returns the index, and how far u lies into that interval, in [0,1].
template <class T>
std::pair<std::size_t, double> find(std::span<const T> sums, double u) {
  const auto above = std::upper_bound(sums.begin(), sums.end() - 1, u, [](double a, T b) { return a < double(b); });
  const auto index = static_cast<std::size_t>(above - sums.begin());
  const double begin = index == 0 ? 0.0 : double(sums[index - 1]), size = double(sums[index]) - begin;
  return {index, size > 0 ? std::clamp((u - begin) / size, 0.0, 1.0) : 0.5};
}

template <class T>
double share(std::span<const T> sums, std::size_t index) {
  return double(sums[index]) - (index == 0 ? 0.0 : double(sums[index - 1]));
}

std::size_t cell(double place, std::size_t count) {
  return std::min(count - 1, static_cast<std::size_t>(std::max(0.0, place * static_cast<double>(count))));
}

}  // namespace

glm::dvec2 to_latlong(glm::dvec3 d) {
  const double u = vm::real::atan2(-d.x, d.z) / kTurn;
  return {u < 0 ? u + 1 : u, vm::real::acos(std::clamp(d.y, -1.0, 1.0)) / std::numbers::pi};
}

glm::dvec3 from_latlong(glm::dvec2 uv) {
  const double polar = uv.y * std::numbers::pi, turn = uv.x * kTurn;
  const double sine = vm::real::sin(polar);
  return {-sine * vm::real::sin(turn), vm::real::cos(polar), sine * vm::real::cos(turn)};
}

PiecewiseConstantSphere::PiecewiseConstantSphere(int width, int height, std::span<const float> values)
    : width_(static_cast<std::size_t>(width)), height_(static_cast<std::size_t>(height)) {
  CHECK(width > 0 && height > 0 && values.size() == width_ * height_,
        "a table of directions has width x height cells");
  for (std::size_t r = 0; r <= height_; ++r) {
    heights_.push_back(vm::real::cos(std::numbers::pi * static_cast<double>(r) / static_cast<double>(height_)));
  }
  columns_.resize(values.size());
  double sum = 0;
  for (std::size_t r = 0; r < height_; ++r) {
    double row = 0;
    for (std::size_t c = 0; c < width_; ++c) row += static_cast<double>(values[r * width_ + c]);
    double running = 0;
    for (std::size_t c = 0; c < width_; ++c) {
      running += static_cast<double>(values[r * width_ + c]);
      columns_[r * width_ + c] = row > 0 ? static_cast<float>(running / row) : 1.0f;
    }
    sum += row * solid_angle(r);
    rows_.push_back(sum);
  }
  mean_ = sum / (2 * kTurn);
  for (double& running : rows_) running = sum > 0 ? running / sum : 0;
}

double PiecewiseConstantSphere::solid_angle(std::size_t row) const {
  return kTurn / static_cast<double>(width_) * (heights_[row] - heights_[row + 1]);
}

glm::vec3 PiecewiseConstantSphere::sample(glm::vec2 u) const {
  const auto [row, down] = find(std::span<const double>(rows_), static_cast<double>(u.y));
  const auto [column, along] = find(std::span(columns_).subspan(row * width_, width_), static_cast<double>(u.x));
  const double y = heights_[row] + down * (heights_[row + 1] - heights_[row]);
  const double sine = std::sqrt(std::max(0.0, 1 - y * y));
  const SinCos turn =
      sincos_turn(static_cast<float>((static_cast<double>(column) + along) / static_cast<double>(width_)));
  return {-sine * static_cast<double>(turn.sin), y, sine * static_cast<double>(turn.cos)};
}

float PiecewiseConstantSphere::pdf(glm::vec3 direction) const {
  if (!(mean_ > 0)) return 0;
  const glm::dvec2 uv = to_latlong(glm::dvec3(direction));
  const std::size_t row = cell(uv.y, height_), column = cell(uv.x, width_);
  const double chance =
      share(std::span<const double>(rows_), row) * share(std::span(columns_).subspan(row * width_, width_), column);
  return static_cast<float>(chance / solid_angle(row));
}

}  // namespace fathom::runtime
