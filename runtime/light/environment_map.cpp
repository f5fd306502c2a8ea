#include "runtime/light/environment_map.h"

#include <algorithm>
#include <cstdint>
#include <numbers>
#include <utility>

#include "runtime/base/color.h"

namespace fathom::runtime {
namespace {

// Share of the background's light by which it exceeds its mean, below which it counts as even.
constexpr double kMinUneven = 1e-3;

// Returns the mean luminance over each pixel of the image after bilinear filtering: weights 1, 6, 1 of 8 along each
// axis.
std::vector<float> filtered_luminance(const EnvironmentImage& image) {
  const int width = image.width, height = image.height;
  std::vector<float> across(image.pixels.size()), out(image.pixels.size());
  const auto at = [&](int x, int y) {
    return static_cast<std::size_t>(std::clamp(y, 0, height - 1)) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>((x + width) % width);
  };
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const auto l = [&](int i) { return luminance(image.pixels[at(i, y)]); };
      across[at(x, y)] = 0.125f * l(x - 1) + 0.75f * l(x) + 0.125f * l(x + 1);
    }
  }
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      out[at(x, y)] = 0.125f * across[at(x, y - 1)] + 0.75f * across[at(x, y)] + 0.125f * across[at(x, y + 1)];
    }
  }
  return out;
}

// Subtracts the mean. The little that rounding leaves of an even background is not sampled, either.
std::vector<float> excess(int width, int height, std::vector<float> luminances, double mean_of_all) {
  for (float& value : luminances) value = std::max(value - static_cast<float>(mean_of_all), 0.0f);
  if (mean_over_sphere(width, height, luminances) < kMinUneven * mean_of_all) {
    std::fill(luminances.begin(), luminances.end(), 0.0f);
  }
  return luminances;
}

vm::Digest digest_of(const std::vector<glm::vec3>& pixels) {
  static_assert(sizeof(glm::vec3) == 3 * sizeof(float));
  const auto bytes = std::as_bytes(std::span(pixels));
  return vm::digest({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
}

}  // namespace

UnevenLight::UnevenLight(int width, int height, std::vector<float> luminances, std::span<const glm::vec3> pixels)
    : mean_of_all(mean_over_sphere(width, height, luminances)),
      sphere(width, height, excess(width, height, std::move(luminances), mean_of_all), pixels),
      even(std::numbers::pi_v<float> * static_cast<float>(mean_of_all - sphere.mean())) {}

EnvironmentMap::EnvironmentMap(const EnvironmentImage& image)
    : width(image.width),
      height(image.height),
      digest(digest_of(image.pixels)),
      light(width, height, filtered_luminance(image), image.pixels),
      warning(image.warning) {}

std::variant<std::shared_ptr<const EnvironmentMap>, ImageReadError> read_background(const std::string& path,
                                                                                    const ReadLimits& limits) {
  constexpr auto kAbout = "the scene's background: ";
  auto read = read_environment(path, limits);
  if (auto* unread = std::get_if<ImageReadError>(&read))
    return ImageReadError{kAbout + unread->problem, unread->missing};
  auto& image = std::get<EnvironmentImage>(read);
  if (!image.warning.empty()) image.warning = kAbout + image.warning;
  return std::make_shared<const EnvironmentMap>(image);
}

}  // namespace fathom::runtime
