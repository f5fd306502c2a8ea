// PNG by libpng, row by row. Source: W3C, "Portable Network Graphics (PNG) Specification", second edition, 2003.
// Tested by: tests/runtime/image_io_test.cpp
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace fathom::runtime {

// Puts row `y`, from the top, as the file has it: three samples a pixel of 8 bits, or of 16, the high byte first.
using PngRow = std::function<void(int y, std::span<std::uint8_t> bytes)>;

// The file's bytes, with a chunk that says sRGB when `srgb`; empty when libpng fails. `bits` is 8 or 16.
std::vector<std::uint8_t> encode_png(int width, int height, int bits, bool srgb, const PngRow& row);

// Whether a file's picture data unpacks to more than `most` bytes; nothing of it is kept. False where it is no PNG.
bool png_unpacks_beyond(std::span<const std::uint8_t> bytes, double most);

}  // namespace fathom::runtime
