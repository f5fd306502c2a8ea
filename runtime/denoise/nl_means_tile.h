// Non-local means over one tile: the inner loops of nl_means.h, compiled for every instruction set, and what they
// read and make.
//
// Tested by: tests/runtime/denoise/denoise_test.cpp
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "runtime/base/pixel_rect.h"
#include "runtime/denoise/plane.h"

namespace fathom::runtime {

inline constexpr int kWindow = 8;  // pixels to each side that are averaged
inline constexpr int kPatch = 2;   // pixels to each side that are compared

inline constexpr int kMostLanes = 16;  // floats in a register, at most

// A plane with a margin, so that the inner loops need not ask where the picture ends; 0 there. Registers may
// be read from any place of it.
class Framed {
 public:
  Framed() = default;
  Framed(const Plane& plane, int width, int height) : stride_(width + 2 * kMargin) {
    values_.resize(static_cast<std::size_t>(stride_) * static_cast<std::size_t>(height + 2 * kMargin) + kMostLanes);
    for (int y = 0; y < height; ++y) {
      std::copy_n(plane.begin() + static_cast<std::ptrdiff_t>(y) * width, width, values_.data() + at(y));
    }
  }
  const float* row(int y) const { return values_.data() + at(y); }

 private:
  static constexpr int kMargin = kWindow + kPatch;
  std::ptrdiff_t at(int y) const { return static_cast<std::ptrdiff_t>(y + kMargin) * stride_ + kMargin; }

  std::ptrdiff_t stride_ = 0;
  std::vector<float> values_;
};

// What filtering reads.
struct NlMeansFrame {
  int width, height;
  std::array<std::array<Framed, 3>, 2> copies;
  std::array<Framed, 6> features;
  std::array<Framed, 2> sharpness;  // what squared differences of the first and last three features count
  Framed depth, slope_x, slope_y, valid;
  Framed noise;     // variance of a copy as it looks, all channels together
  Framed variance;  // the same, smoothed
};

// What filtering makes: for each set of weights the picture and its error.
inline constexpr std::size_t kCandidates = 3;
struct NlMeansFiltered {
  std::array<std::array<Plane, 3>, kCandidates> colors;
  std::array<Plane, kCandidates> errors;
};

inline constexpr int kTile = 32;  // a multiple of kMostLanes

// One thread's, kept from tile to tile.
struct TileBuffers {
  using Row = std::array<float, kTile>;
  using Grown = std::array<std::array<float, kTile + kMostLanes>, kTile + 2 * kPatch>;
  using Sums = std::array<std::array<Row, 4>, kTile>;  // [y][red, green, blue, weight][x]

  std::array<Grown, 2> distances;  // by each copy's colours
  Row unlikeness, share, alike;    // of the row and offset at hand
  // For each set of weights and each copy: of the copy's values by the other's weights.
  std::array<std::array<Sums, 2>, kCandidates> sums;
};

// `tile` has kTile x kTile pixels at most.
void filter_tile(const NlMeansFrame& in, const PixelRect& tile, TileBuffers& buffers, NlMeansFiltered& out);

}  // namespace fathom::runtime
