// Reads images from files as floats. The file name's ending, in any case, selects the format. All formats that
// runtime/image/image_io.h writes can be read.
//
// OpenEXR files give all their channels, colours in linear sRGB, over the display window: 0 where the file has no
// data. Other files give R, G, B and, with transparency, A, y downwards. The samples of PNG, JPEG and BMP are taken
// for sRGB signals and decoded to linear light, which PFM and HDR hold.
// Tested by: tests/runtime/image/image_read_test.cpp
#pragma once

#include <string>
#include <variant>

#include "runtime/image/float_image.h"

namespace fathom::runtime {

// The reason why an image could not be read, as a message.
struct ImageReadError {
  std::string problem;
  bool missing = false;  // the file could not be opened or read; otherwise its content is not what its name says
};

// Limits on reading an image.
struct ReadLimits {
  double memory = 0x1p36;  // bytes of the file, its decoded samples and the floats, together
};

// Reads an image. Refuses an image above the limits before allocating its memory.
std::variant<FloatImage, ImageReadError> read_image(const std::string& path, const ReadLimits& limits = {});

}  // namespace fathom::runtime
