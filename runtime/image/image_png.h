// PNG by libpng, row by row. Source: W3C, "Portable Network Graphics (PNG) Specification", second edition, 2003.
// Tested by: tests/runtime/image/image_io_test.cpp, image_read_test.cpp
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace fathom::runtime {

// Writes row `y`, counted from the top, in the file's format: three samples per pixel of 8 bits, or of 16 bits with
// the high byte first.
using PngRow = std::function<void(int y, std::span<std::uint8_t> bytes)>;

// Returns the file's bytes, with an sRGB chunk if `srgb`; empty when libpng fails. `bits` is 8 or 16.
std::vector<std::uint8_t> encode_png(int width, int height, int bits, bool srgb, const PngRow& row);

// Samples [y][x][component] of 1 (grey), 2 (grey and alpha), 3 or 4 components, all of 16 bits for any file.
struct PngImage {
  int width = 0, height = 0, components = 0;
  std::vector<std::uint16_t> samples;
};

// Returns the file's image, or why it cannot be read. An image that needs more than `memory` bytes is refused before
// memory is allocated. Ignores colour profiles.
std::variant<PngImage, std::string> decode_png(std::span<const std::uint8_t> bytes, double memory);

}  // namespace fathom::runtime
