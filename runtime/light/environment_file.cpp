#include "runtime/light/environment_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

#include "runtime/image/image.h"
#include "runtime/image/image_read.h"
#include "runtime/sampling/sphere_tables.h"

namespace fathom::runtime {
namespace {

// Bytes a pixel while an EnvironmentMap is made: the pixels, the luminances before and after the filter, the cells,
// and the running sums with their guide, which has an entry for at most two cells.
constexpr std::size_t kBytesOfMap =
    sizeof(glm::vec3) + 2 * sizeof(float) + sizeof(SphereCell) + sizeof(float) + sizeof(std::uint32_t) / 2;

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
  if (const auto kind = image.attributes.find("envmap"); kind != image.attributes.end()) {
    constexpr int kCube = 1;
    if (kind->second == Attribute(kCube)) {
      return ImageReadError{
          fmt::format("`{}` is a cube of six faces, and a background is a map of longitude and latitude: `exrenvmap "
                      "-l` converts it",
                      path)};
    }
  }
  const std::optional<LayerValues> light = layer_of(image, Layer::Beauty);
  if (!light) {
    return ImageReadError{
        fmt::format("`{}` has no channels R, G and B and no Y; its channels: {}", path, channel_names(image))};
  }
  const double pixels = static_cast<double>(image.area.pixels());
  const std::size_t bytes = std::max(image.values.size() * sizeof(float) + sizeof(glm::vec3), kBytesOfMap);
  const double needed = pixels * static_cast<double>(bytes);
  if (needed > limits.memory) {
    return ImageReadError{fmt::format("`{}` cannot be used: {}", path, too_much_memory(needed, limits.memory))};
  }
  EnvironmentImage result{image.width, image.height, {}, {}};
  result.pixels.reserve(image.area.pixels());
  for (int y = 0; y < result.height; ++y) {
    for (int x = 0; x < result.width; ++x) {
      const glm::vec3 pixel = light->at(x, y);
      result.pixels.emplace_back(usable(pixel.x), usable(pixel.y), usable(pixel.z));
    }
  }
  if (const auto problem = not_finite(*light)) {
    result.warning = fmt::format("`{}` has {}: NaN and -infinity are read as 0, infinity as 65504", path, *problem);
  }
  return result;
}

}  // namespace fathom::runtime
