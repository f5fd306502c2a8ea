// Maps: images of one number per pixel, with their colour scale.
//
// The colours run from dark violet to yellow, perceptually even and also readable in grey: viridis (S. van der Walt,
// N. Smith, "mpl colormaps", 2015), which its authors gave to the public domain, as eleven colours with linear
// interpolation between them. NaN is grey. On a logarithmic scale, 0 and negative values are black. Values beyond the
// scale have the colour of its nearer end.
// Tested by: tests/runtime/chart/chart_colormap_test.cpp
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

// Returns the colour at `fraction`, clamped to [0,1].
Rgb viridis(double fraction);

struct ColorScale {
  bool logarithmic = false;
  double lo = 0, hi = 1;  // lo < hi; 0 < lo on a logarithmic scale

  Rgb color(double value) const;
};

// Returns a scale that holds all finite values and ends at round numbers. A logarithmic scale ends at powers of ten.
// A linear scale runs from 0 to 1, 2 or 5 times a power of ten if no value is negative. If all values are 0 or
// missing, the scale is [1, 10] (logarithmic) or [0, 1].
ColorScale scale_for(std::span<const float> values, bool logarithmic);

// Draws the map [y][x], y downwards, above a strip with the numbered scale and boxes named "nan" and "0" that explain
// grey and black. The image is `kScaleHeight` pixels higher than the map. Below 160 pixels of width the strip has no
// text. Throws std::invalid_argument unless there are width * height values.
inline constexpr int kScaleHeight = 34;
ByteImage draw_map(std::span<const float> values, int width, int height, const ColorScale& scale);

}  // namespace fathom::runtime
