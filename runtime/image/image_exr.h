// OpenEXR files: all channels of a picture in one part, scan lines, ZIP compression. The data window is the image's
// area, the display window the whole picture.
//
// Written row by row, so that none is held whole. Without OpenEXR's own threads: the same image gives the same bytes.
// Source: F. Kainz, R. Bogart, "Technical Introduction to OpenEXR", 2009. Tested by:
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

// Floats as floats, whole numbers as UINT. The reason when it cannot be done, and then the target is as it was.
[[nodiscard]] std::optional<std::string> write_exr(const ImageRows& image, const std::string& path);
[[nodiscard]] std::optional<std::string> write_exr(const ImageRows& image, AtomicFile& file);  // commits it

// The image in the bytes of a file, halves and UINTs as floats, or what is wrong with them. Attributes of kinds that
// Attribute does not have are left out.
std::variant<FloatImage, std::string> decode_exr(const std::vector<std::uint8_t>& bytes, double memory = 0x1p36);

}  // namespace fathom::runtime
