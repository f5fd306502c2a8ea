#include "runtime/light/environment_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runtime/image/image_read.h"

namespace fathom::runtime {
namespace {

// Infinity, as half floats hold at the sun, becomes the largest half. A limit keeps sums of pixels from overflowing.
float usable(float value) {
  constexpr float kLargestHalf = 65504, kLargest = 1e20f;
  if (!(value > 0)) return 0;
  return std::isinf(value) ? kLargestHalf : std::min(value, kLargest);
}

}  // namespace

std::variant<EnvironmentImage, ImageReadError> read_environment(const std::string& path, const ReadLimits& limits) {
  const auto read = read_image(path, limits);
  if (const auto* unread = std::get_if<ImageReadError>(&read)) return *unread;
  const FloatImage& image = std::get<FloatImage>(read);
  // An image of luminance alone is grey.
  const std::vector<float>* grey = image.channel("Y");
  const std::vector<float>* channels[] = {image.channel("R"), image.channel("G"), image.channel("B")};
  for (const std::vector<float>*& channel : channels) {
    if (channel == nullptr) channel = grey;
    if (channel == nullptr) return ImageReadError{fmt::format("`{}` has neither channels R, G and B nor Y", path)};
  }
  const double pixels = static_cast<double>(image.area.pixels());
  const double needed = pixels * static_cast<double>(image.values.size() * sizeof(float) + sizeof(glm::vec3));
  if (needed > limits.memory) {
    return ImageReadError{fmt::format("`{}` cannot be used: {}", path, too_much_memory(needed, limits.memory))};
  }
  EnvironmentImage result{image.area.width(), image.area.height(), {}};
  result.pixels.reserve(image.area.pixels());
  for (std::size_t i = 0; i < channels[0]->size(); ++i) {
    result.pixels.emplace_back(usable((*channels[0])[i]), usable((*channels[1])[i]), usable((*channels[2])[i]));
  }
  return result;
}

}  // namespace fathom::runtime
