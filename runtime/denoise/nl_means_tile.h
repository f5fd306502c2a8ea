// Non-local means over one tile: the inner loops of nl_means.h, compiled for every instruction set, with their input
// and output.
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

inline constexpr int kWindow = 8;  // averaged pixels to each side
inline constexpr int kPatch = 2;   // compared pixels to each side

inline constexpr int kMaxLanes = 16;  // maximum number of floats in a register

// A plane with a margin of zeros, so that the inner loops need not test for the image's border. A register may be
// loaded from any place in the plane.
class PaddedPlane {
 public:
  PaddedPlane() = default;
  PaddedPlane(const Plane& plane, int width, int height) : stride_(width + 2 * kMargin) {
    values_.resize(static_cast<std::size_t>(stride_) * static_cast<std::size_t>(height + 2 * kMargin) + kMaxLanes);
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

// Input of the filter.
struct NlMeansPlanes {
  int width, height;
  std::array<std::array<PaddedPlane, 3>, 2> copies;
  std::array<PaddedPlane, 6> features;
  std::array<PaddedPlane, 2> sharpness;  // weights of squared differences of the first and last three features
  PaddedPlane depth, slope_x, slope_y, valid;
  PaddedPlane noise;     // variance of a copy as seen in each pixel, all channels together
  PaddedPlane variance;  // `noise`, smoothed
};

// Output of the filter: the image and its error for each set of weights.
inline constexpr std::size_t kCandidates = 3;
struct NlMeansFiltered {
  std::array<std::array<Plane, 3>, kCandidates> colors;
  std::array<Plane, kCandidates> errors;
};

inline constexpr int kTile = 32;  // a multiple of kMaxLanes

// Buffers of one thread, kept from tile to tile.
struct TileBuffers {
  using Row = std::array<float, kTile>;
  using PaddedTile = std::array<std::array<float, kTile + kMaxLanes>, kTile + 2 * kPatch>;
  using Sums = std::array<std::array<Row, 4>, kTile>;  // [y][red, green, blue, weight][x]

  std::array<PaddedTile, 2> distances;   // by the colours of each copy
  Row dissimilarity, share, similarity;  // of the current row and offset
  // For each set of weights and each copy: sums of the copy's values by the other copy's weights.
  std::array<std::array<Sums, 2>, kCandidates> sums;
};

// `tile` has at most kTile x kTile pixels.
void filter_tile(const NlMeansPlanes& in, const PixelRect& tile, TileBuffers& buffers, NlMeansFiltered& out);

}  // namespace fathom::runtime
