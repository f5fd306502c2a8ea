// The picture cut into squares, which threads take one after another.
// Tested by: tests/runtime/render_test.cpp
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <optional>

namespace fathom::runtime {

// The side that cuts a picture into enough tiles for `threads`: `most`, or less when the picture is small. The last
// tiles keep some threads waiting for one tile's time.
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

// Pixels [x0, x1) x [y0, y1).
struct Tile {
  int x0, y0, x1, y1;
};

// Tiles in rows from the top; the last of a row or column may be cut short. take() is safe from any thread.
class Tiles {
 public:
  Tiles(int width, int height, int side) : width_(width), height_(height), side_(side) {}

  std::optional<Tile> take() {
    const std::int64_t columns = (width_ + side_ - 1) / side_, rows = (height_ + side_ - 1) / side_;
    const std::int64_t index = next_.fetch_add(1, std::memory_order_relaxed);
    if (index >= columns * rows) return std::nullopt;
    const int x = static_cast<int>(index % columns) * side_, y = static_cast<int>(index / columns) * side_;
    return Tile{x, y, std::min(width_, x + side_), std::min(height_, y + side_)};
  }

 private:
  int width_, height_, side_;
  std::atomic<std::int64_t> next_{0};
};

}  // namespace fathom::runtime
