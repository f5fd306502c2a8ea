// Maps: a number per pixel as a picture, with the scale it is read by.
//
// Colours run from dark violet to yellow, evenly to the eye and in grey as well: viridis (S. van der Walt, N. Smith,
// "mpl colormaps", 2015), which its authors gave to the public domain, by eleven of its colours and straight lines
// between them. NaN is grey. On a logarithmic scale 0 and what is negative is black; beyond the scale's ends the
// end's colour. Tested by: tests/runtime/chart/chart_colormap_test.cpp
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "runtime/image/image.h"

namespace fathom::runtime {

using Rgb = std::array<std::uint8_t, 3>;  // sRGB encoded
inline constexpr Rgb kMissing{128, 128, 128};
inline constexpr Rgb kNothing{0, 0, 0};

// The colour of `fraction` in [0,1], clamped to it.
Rgb viridis(double fraction);

struct ColorScale {
  bool logarithmic = false;
  double lo = 0, hi = 1;  // lo < hi; 0 < lo on a logarithmic scale

  Rgb color(double value) const;
};

// The scale that holds all finite values, its ends round numbers: powers of ten, or for a linear scale 0 and 1, 2 or
// 5 times a power of ten where nothing is negative. Values that are all 0 or missing give [1, 10] or [0, 1].
ColorScale scale_for(std::span<const float> values, bool logarithmic);

// The map [y][x], y downwards, above a strip that shows the scale with numbers, and what grey and black mean: boxes
// named "nan" and "0". The picture is `kScaleHeight` pixels higher than the map; below 160 pixels wide it has no
// numbers. Throws std::invalid_argument when there are not width * height values.
inline constexpr int kScaleHeight = 34;
Picture draw_map(std::span<const float> values, int width, int height, const ColorScale& scale);

}  // namespace fathom::runtime
