// Error metrics between an image and its reference.
//
// FLIP, a perceptual metric, has a file of its own: runtime/image/flip.h.
// Tested by: tests/runtime/image/image_diff_test.cpp
#pragma once

#include <cstdint>
#include <span>

namespace fathom::runtime {

// Linear sRGB, [y][x][rgb], y downwards.
struct RgbView {
  int width = 0, height = 0;
  std::span<const float> rgb;
};

// Means over all channels of all pixels, except pixels where one of the images is not finite.
struct Differences {
  double mse = 0;
  double relmse = 0;
  double max = 0;             // of the absolute differences
  double mean = 0;            // image minus reference: the difference of brightness
  std::uint64_t invalid = 0;  // number of pixels left out
};

// relMSE is the mean of (a - b)^2 / (b^2 + 0.01), where b is the reference. Source: Rousselle, Knaus, Zwicker,
// "Adaptive Sampling and Reconstruction using Greedy Error Minimization", SIGGRAPH Asia 2011, equation 5.
inline constexpr double kRelMseEpsilon = 0.01;

// The images must be of one size.
Differences compare(RgbView image, RgbView reference);

}  // namespace fathom::runtime
