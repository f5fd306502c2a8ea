// Pictures from files, by the file name's ending in any case, as numbers: everything runtime/image/image_io.h writes.
//
// Of OpenEXR all channels as they are; of the others R, G, B and, where there is transparency, A, y downwards. The
// samples of PNG, JPEG and BMP are taken for sRGB signals and decoded to linear light; PFM and HDR hold linear light.
// Tested by: tests/runtime/image/image_read_test.cpp
#pragma once

#include <string>
#include <variant>

#include "runtime/image/float_image.h"

namespace fathom::runtime {

// Why a picture could not be read, for people.
struct UnreadImage {
  std::string problem;
  bool missing = false;  // the file could not be opened or read; otherwise it does not hold what its name says
};

// What reading a picture may take.
struct ReadLimits {
  double memory = 0x1p36;  // bytes: of the file, what it is decoded from and the numbers, together
};

// Refuses a picture that would take more before it takes it.
std::variant<FloatImage, UnreadImage> read_image(const std::string& path, const ReadLimits& limits = {});

}  // namespace fathom::runtime
