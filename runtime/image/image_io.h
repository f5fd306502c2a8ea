// Writes images to files. The file name's ending, in any case, selects the format: see the table kImageFormats.
//
// PNG (8 or 16 bits), JPEG (quality 95) and BMP hold images for display. OpenEXR (all layers of a render in one file,
// runtime/image/image_exr.h), portable float maps and Radiance's HDR (one layer each) hold the floats themselves.
// Every file appears whole or not at all (runtime/base/atomic_file.h). Reading: runtime/image/image_read.h.
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
  bool for_display;  // holds an image for display, not floats
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

// Returns the format's row for a file name; nullptr when its ending is not in the table.
const ImageFormatInfo* image_format_of(const std::string& path);

// Returns ".png, .jpg, .jpeg, .bmp" for formats that are shown; with ", .exr, .pfm, .hdr" all formats.
std::string image_endings(bool display_only = false);

// True if the name ends in .pfm, in any case.
bool is_float_map(const std::string& path);

// Returns why no image can be written under this name, or nothing. Callers ask before rendering.
std::optional<std::string> check_image_path(const std::string& path);

struct ImageOptions {
  ToneMapping tone;  // of the beauty layer, in formats that are shown
  int bits = 8;      // 8 or 16 per sample; 16 only for formats with `deep`
};

// Writes a layer in any format except OpenEXR. Returns the reason when that fails, and then the target is as it was.
// Float formats hold the layer's own values: linear sRGB, scene units, normals from -1 to 1. HDR has no negative
// numbers, so it holds n/2 + 1/2 for hits.
[[nodiscard]] std::optional<std::string> write_layer(const LayerValues& layer, const ImageOptions& options,
                                                     const std::string& path);
[[nodiscard]] std::optional<std::string> write_layer(const LayerValues& layer, const ImageOptions& options,
                                                     ImageFormat format, AtomicFile& file);  // commits it

// Encodes an image of 8 bits in a format that is shown. Returns the bytes of a file, empty when the encoder fails.
// write_image() writes these bytes to a file, like write_layer().
std::vector<std::uint8_t> encode_image(const ByteImage& image, ImageFormat format);
[[nodiscard]] std::optional<std::string> write_image(const ByteImage& image, const std::string& path);
[[nodiscard]] std::optional<std::string> write_image(const ByteImage& image, ImageFormat format, AtomicFile& file);

// Writes values [y][x], y downwards, like write_layer(), as a grey portable float map: 32 bits per value, little
// endian, rows from the bottom. Source: Debevec, "PFM Portable FloatMap Image Format", 2001.
[[nodiscard]] std::optional<std::string> write_float_map(std::span<const float> values, int width, int height,
                                                         const std::string& path);

}  // namespace fathom::runtime
