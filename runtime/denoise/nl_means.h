// Non-local means of a picture that is there twice, with independent noise.
//
// A pixel becomes the mean of a round window that fades out. A neighbour counts as much as the patch around it is
// like the patch around the pixel (Buades, Coll, Morel, "A Non-Local Algorithm for Image Denoising", CVPR 2005), the
// noise that is to be expected between them taken off (Rousselle, Knaus, Zwicker, "Adaptive Rendering with Non-Local
// Means Filtering", SIGGRAPH Asia 2012, section 3), and as what is seen there is alike (Rousselle, Manzi, Zwicker
// 2013). Each copy's weights come from the other copy.
//
// Since weights do not depend on the noise they weigh, Stein's unbiased risk estimate is short: a mean F of y with
// the share s for the pixel itself has the expected squared error E |F - y|^2 + (2 s - 1) var y. Three sets of
// weights are tried, and every pixel takes the one with the least error around it.
//
// Tested by: tests/runtime/denoise/denoise_test.cpp
#pragma once

#include <array>

#include "runtime/denoise/plane.h"

namespace fathom::runtime {

struct NlMeansInput {
  int width = 0, height = 0;
  std::array<std::array<Plane, 3>, 2> copies;  // finite
  std::array<Plane, 6> features;               // finite, of [-1,1]: differences below a tenth do not count for much
  Plane depth;                                 // finite; told apart where it leaves its slope
  Plane valid;                                 // 1, or 0 for pixels whose colour is not to be used
};

// The filtered picture; a pixel that no valid one is like keeps the mean of its copies.
std::array<Plane, 3> nl_means(const NlMeansInput& input, int threads);

}  // namespace fathom::runtime
