// Pictures to files: PNG, JPEG (quality 95) and BMP, by the file name's ending in any case (png, jpg, jpeg, bmp).
// Numbers, one a pixel, to portable float maps (pfm).
//
// A file appears whole or not at all: it is written beside its target, synced, and renamed.
// Tested by: tests/runtime/image_io_test.cpp
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "runtime/image.h"

namespace fathom::runtime {

enum class ImageFormat { Png, Jpeg, Bmp };

// The format a file name asks for; nothing when its ending is not one of ours.
std::optional<ImageFormat> image_format_of(const std::string& path);

// Whether the name ends in .pfm, in any case.
bool is_float_map(const std::string& path);

// Why no picture can be written under this name, or nothing. To be asked before rendering.
std::optional<std::string> check_image_path(const std::string& path);

// The same for a file of any ending: whether its folder is there and open to us.
std::optional<std::string> check_file_path(const std::string& path);

// The picture as the bytes of a file; empty when the encoder fails.
std::vector<std::uint8_t> encode_image(const Picture& picture, ImageFormat format);

// Writes the picture; the reason when it cannot be done, and then the target is as it was.
[[nodiscard]] std::optional<std::string> write_image(const Picture& picture, const std::string& path);

// Writes values [y][x], y downwards, the same way as a grey portable float map: 32 bits each, little endian, rows
// from the bottom. Source: Debevec, "PFM Portable FloatMap Image Format", 2001.
[[nodiscard]] std::optional<std::string> write_float_map(std::span<const float> values, int width, int height,
                                                         const std::string& path);

// Writes bytes the same way: beside the target, synced, renamed.
[[nodiscard]] std::optional<std::string> write_file(const std::vector<std::uint8_t>& bytes, const std::string& path);

}  // namespace fathom::runtime
