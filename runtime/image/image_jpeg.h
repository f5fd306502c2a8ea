// JPEG by libjpeg-turbo: baseline and progressive, grey and coloured. Source: ITU-T T.81, 1992.
// Tested by: tests/runtime/image/image_jpeg_test.cpp, image_read_test.cpp
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace fathom::runtime {

// Samples [y][x][component] of 1 (grey) or 3 components.
struct JpegImage {
  int width = 0, height = 0, components = 0;
  std::vector<std::uint8_t> samples;
};

// Returns the file's image, or why it cannot be read: the image needs more than `memory` bytes, the file is too short
// for its size in pixels, or the data end or make no sense before the last pixel. Ignores colour profiles.
std::variant<JpegImage, std::string> decode_jpeg(std::span<const std::uint8_t> bytes, double memory);

}  // namespace fathom::runtime
