#include "runtime/cli/plan/pixel_costs.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "runtime/render.h"

namespace fathom::cli {
namespace {

constexpr int kWidth = 160;  // pixels
constexpr std::uint32_t kSamples = 4;
constexpr double kSampleEvaluations = 8;  // fixed cost per sample for shading and the film, in field evaluations

}  // namespace

PixelCosts::PixelCosts(const compiler::CompiledScene& scene, runtime::RenderOptions options, int width, int height,
                       std::uint32_t spp)
    : frame_width_(width), frame_height_(height), width_(std::min(width, kWidth)) {
  height_ = std::max(1, static_cast<int>(std::lround(static_cast<double>(height) * width_ / width)));
  options.width = width_;
  options.height = height_;
  options.sample_range = {0, std::min(spp, kSamples)};
  options.layers.cost = true;
  const runtime::RenderResult result = runtime::render(scene, options);
  double sum = 0;
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      seconds_.push_back(result.film.means(x, y).evaluations + kSampleEvaluations);
      sum += seconds_.back();
    }
  }
  for (double& cost : seconds_) cost *= result.stats.seconds / (sum * options.sample_range->size());
}

double PixelCosts::sum(const runtime::PixelRect& area) const {
  const double across = static_cast<double>(width_) / frame_width_,
               down = static_cast<double>(height_) / frame_height_;
  const auto range = [](double from, double to, int length) {
    const int first = std::min(static_cast<int>(from), length - 1);
    return std::pair(first, std::clamp(static_cast<int>(std::ceil(to)), first + 1, length));
  };
  const auto [x0, x1] = range(area.x0 * across, area.x1 * across, width_);
  const auto [y0, y1] = range(area.y0 * down, area.y1 * down, height_);
  double sum = 0;
  for (int y = y0; y < y1; ++y) {
    for (int x = x0; x < x1; ++x) {
      sum += seconds_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x)];
    }
  }
  return sum / ((x1 - x0) * (y1 - y0)) * static_cast<double>(area.pixels());
}

}  // namespace fathom::cli
