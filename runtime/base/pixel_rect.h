// A rectangle of pixels: half open, with the image's top left pixel at (0, 0).
#pragma once

#include <cstddef>

namespace fathom::runtime {

// Pixels [x0, x1) x [y0, y1).
struct PixelRect {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;

  int width() const { return x1 - x0; }
  int height() const { return y1 - y0; }
  std::size_t pixels() const { return static_cast<std::size_t>(width()) * static_cast<std::size_t>(height()); }
  // Returns the pixel's index in [y][x] rows of this rectangle.
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y - y0) * static_cast<std::size_t>(width()) + static_cast<std::size_t>(x - x0);
  }
  bool operator==(const PixelRect&) const = default;
};

}  // namespace fathom::runtime
