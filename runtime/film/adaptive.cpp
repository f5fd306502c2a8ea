#include "runtime/film/adaptive.h"

#include <algorithm>
#include <cmath>
#include <glm/exponential.hpp>
#include <limits>

#include "runtime/base/color.h"
#include "runtime/base/tiles.h"
#include "runtime/film/film.h"
#include "vm/program/check.h"

namespace fathom::runtime {
namespace {

constexpr double kMinShare = 0.5, kMaxShare = 4;  // limits of a share, relative to the average
constexpr std::uint32_t kFirstTest = 16;          // samples per pixel

std::uint32_t pilot_samples(int spp) { return static_cast<std::uint32_t>(spp / 2); }

// Calls use(x, y) for the pixels of one half of a tile.
template <class Use>
void for_each_pixel(PixelRect tile, std::size_t half, const Use& use) {
  for (int y = tile.y0; y < tile.y1; ++y) {
    for (int x = tile.x0; x < tile.x1; ++x) {
      if (half_of(x, y) == half) use(x, y);
    }
  }
}

double pixels_of(PixelRect tile, std::size_t half) {
  double pixels = 0;
  for_each_pixel(tile, half, [&](int, int) { ++pixels; });
  return pixels;
}

// Returns the variance of the pixel's mean luminance over its luminance. The variance is an upper bound: the channels
// count as fully correlated.
double visible_variance(glm::dvec3 radiance, glm::dvec3 variance) {
  const auto deviation = static_cast<double>(luminance(glm::vec3(glm::sqrt(variance))));
  const auto brightness = static_cast<double>(luminance(glm::vec3(radiance)));
  return deviation * deviation / (std::max(brightness, 0.0) + kDark);
}

// Returns the mean over the pixels of one half of a tile of the visible standard deviation of one sample. Unlike the
// root of a mean variance, this mean does not jump with a single bright sample.
double deviation_of(const Film& film, PixelRect tile, std::size_t half) {
  double sum = 0;
  for_each_pixel(tile, half, [&](int x, int y) {
    const RadianceMeans pixel = film.all_radiance(x, y);
    sum += std::sqrt(pixel.samples * visible_variance(pixel.radiance, pixel.variance));
  });
  return sum / std::max(1.0, pixels_of(tile, half));
}

// Convolves [row][column] with the binomial weights 1 2 1 in both directions. A value outside equals the nearest
// value at the edge.
std::vector<double> smoothed(const std::vector<double>& values, int columns) {
  const int rows = static_cast<int>(values.size()) / columns;
  std::vector<double> result;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      double sum = 0;
      for (int y = -1; y <= 1; ++y) {
        for (int x = -1; x <= 1; ++x) {
          const int at = std::clamp(row + y, 0, rows - 1) * columns + std::clamp(column + x, 0, columns - 1);
          sum += (2 - std::abs(x)) * (2 - std::abs(y)) * values[static_cast<std::size_t>(at)];
        }
      }
      result.push_back(sum / 16);
    }
  }
  return result;
}

// Demand of the pixels of one half of a tile: their number, its weight, and its min and max samples
// per pixel.
struct SampleDemand {
  double pixels, weight, min, max;
};

// Returns the factor by which the clamped weights use up the budget.
double fitting_factor(const std::vector<SampleDemand>& demands, double budget) {
  double low = 0, high = 0;
  for (const SampleDemand& demand : demands) high = std::max(high, demand.max / demand.weight);
  for (int i = 0; i < 60; ++i) {
    const double factor = (low + high) / 2;
    double sum = 0;
    for (const SampleDemand& demand : demands)
      sum += demand.pixels * std::clamp(factor * demand.weight, demand.min, demand.max);
    (sum < budget ? low : high) = factor;
  }
  return low;
}

// Computes the number of samples of each half, which the other half decides.
class SampleAllocation {
 public:
  SampleAllocation(const Film& film, int spp, double threshold, const AdaptiveState& state)
      : film_(film), tiles_(film.area(), kAdaptiveTile), average_(spp), threshold_(threshold), state_(state) {}

  // Returns [tile] the number of samples per pixel of `half`.
  std::vector<std::uint32_t> of(std::size_t half) const {
    const std::vector<double> weights = weights_by(1 - half);
    double budget = 0;
    std::vector<SampleDemand> demands;
    for (std::size_t i = 0; i < weights.size(); ++i) {
      demands.push_back(demand(i, half, weights[i]));
      budget += average_ * demands.back().pixels;
      if (state_.tiles[i].ends[half] != 0) budget -= demands.back().pixels * demands.back().max;
    }
    std::vector<SampleDemand> open;
    for (std::size_t i = 0; i < demands.size(); ++i) {
      if (state_.tiles[i].ends[half] == 0) open.push_back(demands[i]);
    }
    const double factor = fitting_factor(open, budget);
    std::vector<std::uint32_t> counts;
    double carried = 0;  // samples left over by rounding down
    for (const SampleDemand& demand : demands) {
      const double share = std::clamp(factor * demand.weight, demand.min, demand.max);
      constexpr double kRounding = 1e-6;  // error of the factor's bisection
      const double count =
          std::min(demand.max, std::floor(share + carried / std::max(1.0, demand.pixels) + kRounding));
      carried += demand.pixels * (share - count);
      counts.push_back(static_cast<std::uint32_t>(count));
    }
    return counts;
  }

 private:
  PixelRect tile(std::size_t i) const { return tiles_.at(static_cast<std::int64_t>(i)); }

  // Returns [tile] the square root of the deviation that half `measuring_half` measures, always above 0.
  std::vector<double> weights_by(std::size_t measuring_half) const {
    std::vector<double> deviations;
    for (std::size_t i = 0; i < state_.tiles.size(); ++i) {
      deviations.push_back(deviation_of(film_, tile(i), measuring_half));
    }
    std::vector<double> weights = smoothed(deviations, tiles_.columns());
    const double max_weight = *std::max_element(weights.begin(), weights.end());
    for (double& weight : weights) weight = max_weight > 0 ? std::sqrt(std::max(weight, 1e-6 * max_weight)) : 1;
    return weights;
  }

  SampleDemand demand(std::size_t i, std::size_t half, double weight) const {
    const std::uint32_t decided = state_.tiles[i].ends[half];
    const double pixels = pixels_of(tile(i), half);
    if (decided != 0) return {pixels, weight, static_cast<double>(decided), static_cast<double>(decided)};
    const double taken = state_.tested_spp;
    double max = kMaxShare * average_;
    if (threshold_ > 0) {
      const double noise = noise_of(film_, tile(i), 1 - half) / threshold_;
      max = std::clamp(std::ceil(taken * noise * noise), taken, max);
    }
    return {pixels, weight, std::min(max, std::max(taken, kMinShare * average_)), max};
  }

  const Film& film_;
  const Tiles tiles_;
  const double average_;  // samples per pixel
  const double threshold_;
  const AdaptiveState& state_;
};

}  // namespace

std::size_t adaptive_stages(double threshold) { return threshold > 0 ? 2 : 1; }

std::uint32_t next_round(std::uint32_t tested_spp, int spp, double threshold) {
  CHECK(spp >= kMinAdaptiveSpp, "too few samples to share out");
  const std::uint32_t last = pilot_samples(spp);
  if (tested_spp >= last) return 0;
  return threshold > 0 ? std::min(last, tested_spp == 0 ? kFirstTest : 2 * tested_spp) : last;
}

double noise_of(const Film& film, PixelRect tile, std::size_t half) {
  double sum = 0, pixels = 0;
  for_each_pixel(tile, half, [&](int x, int y) {
    const RadianceMeans pixel = film.all_radiance(x, y);
    sum += visible_variance(pixel.radiance, pixel.variance);
    ++pixels;
  });
  return pixels > 0 ? std::sqrt(sum / pixels) : std::numeric_limits<double>::infinity();
}

double image_noise(const Film& film, PixelRect tile) {
  double sum = 0;
  for (int y = tile.y0; y < tile.y1; ++y) {
    for (int x = tile.x0; x < tile.x1; ++x) {
      const PixelMeans pixel = film.means(x, y);
      sum += visible_variance(pixel.noisy, pixel.variance);
    }
  }
  return std::sqrt(sum / static_cast<double>(tile.pixels()));
}

void test_convergence(const Film& film, std::uint32_t end, double threshold, AdaptiveState& state) {
  const Tiles tiles(film.area(), kAdaptiveTile);
  for (std::size_t i = 0; i < state.tiles.size() && threshold > 0; ++i) {
    AdaptiveTile& tile = state.tiles[i];
    if (!tile.open()) continue;
    const PixelRect pixels = tiles.at(static_cast<std::int64_t>(i));
    const std::array<bool, 2> converged = {noise_of(film, pixels, 1) <= threshold,
                                           noise_of(film, pixels, 0) <= threshold};
    for (std::size_t half = 0; half < 2; ++half) {
      if (tile.ends[half] == 0 && converged[half]) tile.ends[half] = end;
    }
  }
  state.tested_spp = end;
}

void allocate_samples(const Film& film, int spp, double threshold, AdaptiveState& state) {
  const SampleAllocation allocation(film, spp, threshold, state);
  const std::array<std::vector<std::uint32_t>, 2> counts = {allocation.of(0), allocation.of(1)};
  for (std::size_t i = 0; i < state.tiles.size(); ++i) {
    for (std::size_t half = 0; half < 2; ++half) state.tiles[i].ends[half] = counts[half][i];
  }
}

}  // namespace fathom::runtime
