// A rectangle of pixels cut into square tiles.
// Tested by: tests/runtime/render_test.cpp
#pragma once

#include <algorithm>
#include <cstdint>

#include "runtime/base/pixel_rect.h"

namespace fathom::runtime {

// Returns the side of tiles: `most`, or less where a small image would not give each thread kTilesPerThread tiles. At
// the end of the image some threads wait for the time of one tile.
inline constexpr int kTilesPerThread = 64;
inline int tile_side(int width, int height, int most, int threads) {
  const auto pieces = [](int length, int side) { return (length + side - 1) / side; };
  int side = most;
  while (side > 1 &&
         std::int64_t{pieces(width, side)} * pieces(height, side) < std::int64_t{kTilesPerThread} * threads) {
    side = (side + 1) / 2;
  }
  return side;
}

// Tiles in rows from the top. The last tile of a row or column may be cut short.
class Tiles {
 public:
  Tiles(PixelRect area, int side) : area_(area), side_(side) {}

  int columns() const { return (area_.width() + side_ - 1) / side_; }
  std::int64_t count() const { return std::int64_t{columns()} * ((area_.height() + side_ - 1) / side_); }
  PixelRect at(std::int64_t index) const {
    const int x = area_.x0 + static_cast<int>(index % columns()) * side_;
    const int y = area_.y0 + static_cast<int>(index / columns()) * side_;
    return PixelRect{x, y, std::min(area_.x1, x + side_), std::min(area_.y1, y + side_)};
  }

 private:
  PixelRect area_;
  int side_;
};

}  // namespace fathom::runtime
