// Pictures to files, by the file name's ending in any case: the table kImageFormats.
//
// What a display shows goes to PNG (8 or 16 bits), JPEG (quality 95) and BMP; numbers as they are to OpenEXR (all
// layers of a render in one file, runtime/image/image_exr.h), to portable float maps and to Radiance's HDR (a layer
// each). Every file appears whole or not at all (runtime/base/atomic_file.h). Reading: runtime/image/image_read.h.
// Tested by: tests/runtime/image/image_io_test.cpp
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/base/atomic_file.h"
#include "runtime/image/image.h"

namespace fathom::runtime {

enum class ImageFormat { Png, Jpeg, Bmp, Exr, Pfm, Hdr };

struct ImageFormatInfo {
  std::string_view ending;
  ImageFormat format;
  bool shown;  // holds what a display shows, not numbers
  bool deep;   // may have 16 bits
};
inline constexpr std::array<ImageFormatInfo, 7> kImageFormats = {{
    {"png", ImageFormat::Png, true, true},
    {"jpg", ImageFormat::Jpeg, true, false},
    {"jpeg", ImageFormat::Jpeg, true, false},
    {"bmp", ImageFormat::Bmp, true, false},
    {"exr", ImageFormat::Exr, false, false},
    {"pfm", ImageFormat::Pfm, false, false},
    {"hdr", ImageFormat::Hdr, false, false},
}};

// The row of the format a file name asks for; nullptr when its ending is not one of ours.
const ImageFormatInfo* image_format_of(const std::string& path);

// ".png, .jpg, .jpeg, .bmp" for those that are shown, or with ", .exr, .pfm, .hdr" all.
std::string image_endings(bool shown_only = false);

// Whether the name ends in .pfm, in any case.
bool is_float_map(const std::string& path);

// Why no picture can be written under this name, or nothing. To be asked before rendering.
std::optional<std::string> check_image_path(const std::string& path);

struct PictureOptions {
  ToneMapping tone;  // of the beauty, where the format is shown
  int bits = 8;      // 8 or 16 a sample; 16 where the format may have them
};

// Writes a layer in any format but OpenEXR; the reason when it cannot be done, and then the target is as it was.
// Formats of numbers hold the layer's own: linear sRGB, scene units, normals from -1 to 1 (in HDR, which has no
// negative numbers, n/2 + 1/2 where something was hit).
[[nodiscard]] std::optional<std::string> write_layer(const LayerValues& layer, const PictureOptions& options,
                                                     const std::string& path);
[[nodiscard]] std::optional<std::string> write_layer(const LayerValues& layer, const PictureOptions& options,
                                                     ImageFormat format, AtomicFile& file);  // commits it

// A picture of 8 bits in a format that is shown: as the bytes of a file, empty when the encoder fails; or written the
// same way.
std::vector<std::uint8_t> encode_image(const Picture& picture, ImageFormat format);
[[nodiscard]] std::optional<std::string> write_image(const Picture& picture, const std::string& path);
[[nodiscard]] std::optional<std::string> write_image(const Picture& picture, ImageFormat format, AtomicFile& file);

// Writes values [y][x], y downwards, the same way as a grey portable float map: 32 bits each, little endian, rows
// from the bottom. Source: Debevec, "PFM Portable FloatMap Image Format", 2001.
[[nodiscard]] std::optional<std::string> write_float_map(std::span<const float> values, int width, int height,
                                                         const std::string& path);

}  // namespace fathom::runtime
