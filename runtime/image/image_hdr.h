// Radiance's pictures: 8 bits per colour and an exponent, in any of the three encodings and eight orientations.
// Source: G. Ward, "Radiance File Formats" (filefmts.pdf), and src/common/color.c of Radiance.
// Tested by: tests/runtime/image/image_hdr_test.cpp
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "runtime/image/float_image.h"

namespace fathom::runtime {

// Returns R, G and B in linear sRGB, or why the file cannot be read. The light is divided by all factors in lines
// EXPOSURE and COLORCORR. PRIMARIES and XYZE are converted. `memory`: maximum number of bytes, including `bytes`.
std::variant<FloatImage, std::string> decode_hdr(const std::vector<std::uint8_t>& bytes, double memory);

}  // namespace fathom::runtime
