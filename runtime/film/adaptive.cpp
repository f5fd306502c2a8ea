#include "runtime/film/adaptive.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/exponential.hpp>

#include "runtime/base/color.h"
#include "runtime/film/noise.h"
#include "runtime/sampling/sampler.h"
#include "vm/program/check.h"

namespace fathom::runtime {
namespace {

constexpr double kLeastSampleShare = 0.25, kMostShare = 16;  // of the average
constexpr double kLeastSamples = 2;
// Noise below which a pixel counts as quiet, as a share of the average.
constexpr double kQuiet = 1e-3;

// With the binomial weights 1 4 6 4 1 over 16 along `count` values `stride` apart; those at the ends stand for what
// lies outside.
void smooth_line(double* values, int count, int stride) {
  const auto at = [&](int i) { return values[static_cast<std::ptrdiff_t>(std::clamp(i, 0, count - 1)) * stride]; };
  double before2 = at(0), before = at(0);
  for (int i = 0; i < count; ++i) {
    const double here = at(i);
    const double sum = before2 + 4 * before + 6 * here + 4 * at(i + 1) + at(i + 2);
    values[static_cast<std::ptrdiff_t>(i) * stride] = sum / 16;
    before2 = before;
    before = here;
  }
}

void smooth(std::vector<double>& values, int width, int height) {
  for (int y = 0; y < height; ++y)
    smooth_line(&values[static_cast<std::size_t>(y) * static_cast<std::size_t>(width)], width, 1);
  for (int x = 0; x < width; ++x) smooth_line(&values[static_cast<std::size_t>(x)], height, width);
}

// The pixels' noise as the eye sees it; positive, in no unit.
std::vector<double> visible_noise(std::span<const PixelEstimate> estimates, int width, int height) {
  std::vector<double> noise, brightness;
  for (const PixelEstimate& pixel : estimates) {
    noise.push_back(std::max(pixel.variance, 0.0));
    brightness.push_back(std::max(pixel.mean, 0.0));
  }
  smooth(noise, width, height);
  smooth(brightness, width, height);
  double sum = 0;
  for (std::size_t i = 0; i < noise.size(); ++i) {
    noise[i] = std::sqrt(noise[i] / (brightness[i] + kDark));
    sum += noise[i];
  }
  const double quiet = sum > 0 ? kQuiet * sum / static_cast<double>(noise.size()) : 1;
  for (double& value : noise) value = std::max(value, quiet);
  return noise;
}

// The factor for which the clamped multiples of the noise add up to `total`.
double fitting_factor(const std::vector<double>& noise, double least, double most, double total) {
  double low = 0, high = most / *std::min_element(noise.begin(), noise.end());
  for (int i = 0; i < 60; ++i) {
    const double factor = (low + high) / 2;
    double sum = 0;
    for (const double value : noise) sum += std::clamp(factor * value, least, most);
    (sum < total ? low : high) = factor;
  }
  return high;
}

// Whole numbers with the given total, each nearly its share: the fractions are carried on to the next pixel.
std::vector<int> rounded(const std::vector<double>& shares, std::int64_t total) {
  std::vector<int> counts;
  double sum = 0;
  std::int64_t given = 0;
  for (const double share : shares) {
    sum += share;
    const std::int64_t due = counts.size() + 1 == shares.size() ? total : static_cast<std::int64_t>(sum + 1e-6);
    counts.push_back(static_cast<int>(due - given));
    given = due;
  }
  return counts;
}

}  // namespace

int first_samples(int spp) {
  CHECK(spp >= kLeastAdaptiveSpp, "too few samples to share out");
  return std::max(4, spp / 4);
}

double first_share(int spp) { return static_cast<double>(first_samples(spp)) / spp; }

std::vector<PixelEstimate> estimates_of(const Film& film) {
  CHECK(film.layers().variance, "the film lacks what estimates are made of");
  std::vector<PixelEstimate> estimates;
  const PixelRect area = film.area();
  for (int y = area.y0; y < area.y1; ++y) {
    for (int x = area.x0; x < area.x1; ++x) {
      const RadianceMeans pixel = film.radiance_of({0}, x, y);
      const float deviation = luminance(glm::vec3(glm::sqrt(pixel.variance)));  // of the mean
      const double variance = static_cast<double>(deviation) * static_cast<double>(deviation);
      estimates.push_back({static_cast<double>(luminance(glm::vec3(pixel.radiance))), pixel.samples * variance});
    }
  }
  return estimates;
}

std::uint64_t second_seed(std::uint64_t seed) { return mix64(~seed); }

std::vector<int> second_samples(std::span<const PixelEstimate> estimates, int width, int height, int spp) {
  const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  CHECK(pixels > 0 && estimates.size() == pixels, "an estimate for each pixel");
  const double average = spp - first_samples(spp);
  const double least = std::max(kLeastSamples, kLeastSampleShare * average), most = kMostShare * average;
  std::vector<double> shares = visible_noise(estimates, width, height);
  const double factor = fitting_factor(shares, least, most, average * static_cast<double>(pixels));
  for (double& share : shares) share = std::clamp(factor * share, least, most);
  return rounded(shares, static_cast<std::int64_t>(pixels) * static_cast<std::int64_t>(average));
}

}  // namespace fathom::runtime
