// 8-bit pictures, and how each is made from a film.
// Tested by: tests/runtime/image_test.cpp
#pragma once

#include <cstdint>
#include <vector>

#include "runtime/film.h"

namespace fathom::runtime {

struct Picture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;  // [y][x][rgb], y downwards
};

// Radiance times 2^exposure, clamped to [0,1], sRGB encoded.
Picture beauty_picture(const Film& film, double exposure);

// Colour of the first surface met, sRGB encoded; black where there is none.
Picture albedo_picture(const Film& film);

// Mean normal n of the first surface as n/2 + 1/2, not sRGB encoded: +x is red, +y green, +z blue. Black where no
// sample hit; pixels that hit with a part of their samples show the mean of those.
Picture normal_picture(const Film& film);

// The film's nearest distance over the pixel's, along the rays, not sRGB encoded: white is nearest, half as bright
// twice as far, black infinitely far or nothing. A horizon leaves the foreground its greys.
Picture depth_picture(const Film& film);

}  // namespace fathom::runtime
