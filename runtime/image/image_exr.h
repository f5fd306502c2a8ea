// OpenEXR files: all channels of an image in one part, scan lines, ZIP compression. The data window is the image's
// area, the display window the whole image.
//
// An image is written row by row, so it is never held whole, and without OpenEXR's own threads, so equal images give
// equal bytes. Source: F. Kainz, R. Bogart, "Technical Introduction to OpenEXR", 2009. Tested by:
// tests/runtime/image/image_exr_test.cpp, image_exr_read_test.cpp
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "runtime/base/atomic_file.h"
#include "runtime/image/float_image.h"

namespace fathom::runtime {

// Writes floats as FLOAT, whole numbers as UINT. Returns the reason if that fails; the target is then as it was.
[[nodiscard]] std::optional<std::string> write_exr(const ImageRows& image, const std::string& path);
[[nodiscard]] std::optional<std::string> write_exr(const ImageRows& image, AtomicFile& file);  // commits it

// Decodes the bytes of a file: its first flat part with colours, with HALF and UINT as floats, and colours in linear
// sRGB (runtime/image/image_exr_color.h). Returns the image, or the problem with the bytes. `memory`: maximum number
// of bytes, including `bytes`. Attributes of kinds that Attribute does not have are left out; `envmap` is a number.
std::variant<FloatImage, std::string> decode_exr(const std::vector<std::uint8_t>& bytes, double memory = 0x1p36);

}  // namespace fathom::runtime
