#include "runtime/environment_file.h"

#include <ImfArray.h>
#include <ImfRgbaFile.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <memory>
#include <string_view>

// Only what stb_image knows of Radiance files, under names that other files' copies do not meet.
#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STBI_ONLY_HDR
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wsign-compare"
#pragma GCC diagnostic ignored "-Wshadow"
#include <stb_image.h>
#pragma GCC diagnostic pop

namespace fathom::runtime {
namespace {

constexpr int kMaxSide = 32768;  // pixels

float usable(float value) {
  if (!(value > 0)) return 0;
  return std::min(value, std::numeric_limits<float>::max());
}

bool too_large(int width, int height) { return width > kMaxSide || height > kMaxSide; }
std::string size_reason(int width, int height) {
  return fmt::format("{} x {} pixels are too many; at most {} a side", width, height, kMaxSide);
}

std::variant<EnvironmentImage, std::string> read_hdr(const std::string& path) {
  int width = 0, height = 0, channels = 0;
  const std::unique_ptr<float, void (*)(void*)> data(stbi_loadf(path.c_str(), &width, &height, &channels, 3),
                                                     stbi_image_free);
  if (!data) return fmt::format("it is no Radiance picture that can be read ({})", stbi_failure_reason());
  if (too_large(width, height)) return size_reason(width, height);
  EnvironmentImage image{width, height, {}};
  image.pixels.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  const float* in = data.get();
  for (glm::vec3& pixel : image.pixels) {
    for (int c = 0; c < 3; ++c) pixel[c] = usable(*in++);
  }
  return image;
}

// OpenEXR's own conversions to RGB: luminance pictures become grey.
std::variant<EnvironmentImage, std::string> read_exr(const std::string& path) {
  try {
    Imf::RgbaInputFile file(path.c_str());
    const auto window = file.dataWindow();
    const int width = window.max.x - window.min.x + 1, height = window.max.y - window.min.y + 1;
    if (too_large(width, height)) return size_reason(width, height);
    Imf::Array2D<Imf::Rgba> pixels(height, width);
    file.setFrameBuffer(&pixels[0][0] - window.min.x - static_cast<std::ptrdiff_t>(window.min.y) * width, 1,
                        static_cast<std::size_t>(width));
    file.readPixels(window.min.y, window.max.y);
    EnvironmentImage image{width, height, {}};
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        const Imf::Rgba& p = pixels[y][x];
        image.pixels.emplace_back(usable(p.r), usable(p.g), usable(p.b));
      }
    }
    return image;
  } catch (const std::exception& error) {
    return fmt::format("it is no OpenEXR picture that can be read ({})", error.what());
  }
}

bool ends_in(const std::string& path, std::string_view ending) {
  if (path.size() < ending.size()) return false;
  return std::equal(ending.rbegin(), ending.rend(), path.rbegin(),
                    [](char a, char b) { return a == (b >= 'A' && b <= 'Z' ? b - 'A' + 'a' : b); });
}

}  // namespace

std::variant<EnvironmentImage, std::string> read_environment(const std::string& path) {
  if (ends_in(path, ".hdr")) return read_hdr(path);
  if (ends_in(path, ".exr")) return read_exr(path);
  return std::string("its name ends in neither .hdr nor .exr");
}

}  // namespace fathom::runtime
